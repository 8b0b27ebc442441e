// A fragment → its texel in an image of words, by an atomic; no attachment. What has no memory is not written (O15): with
// ASKS_RESIDENCY the texel's residency code says so, else the page bits.
#extension GL_EXT_nonuniform_qualifier : require
#ifdef ASKS_RESIDENCY
#extension GL_ARB_sparse_texture2 : require
#endif
#include "raster/page_buffers.glsl"
layout(push_constant, scalar) uniform PushBlock { CastPagePush push; };
layout(constant_id = 0) const bool masked = false;
layout(set = 0, binding = 2, r32ui) uniform uimage2DArray words[];
layout(set = 1, binding = 0) uniform sampler2D masks[];
layout(location = 0) in vec2 uv;
layout(location = 1) flat in uvec4 place;           // batch, first word, resolution, layer

bool is_resident(ivec3 texel, out uint stored) {
#ifdef ASKS_RESIDENCY
  uvec4 loaded;
  bool resident = sparseTexelsResidentARB(sparseImageLoadARB(words[push.image], texel, loaded));
  stored = loaded.x;
  return resident;
#else
  uint pages = pages_of(place.z);
  uint page = uint(texel.y) / PageSide * pages + uint(texel.x) / PageSide;
  stored = 0u;
  if ((Uints(Frame(push.frame).v.page_bits).v[place.y + page / 32u] >> page % 32u & 1u) == 0u) return false;
  stored = imageLoad(words[push.image], texel).x;
  return true;
#endif
}

void main() {
  bool cut_out = false;
  if (masked) {
    BatchRecord batch = Batches(push.batches).v[place.x];
    cut_out = batch.mask != NoIndex && texture(masks[nonuniformEXT(batch.mask)], uv).a * batch.alpha_factor < batch.alpha_cutoff;
  }
  ivec3 texel = ivec3(gl_FragCoord.xy, place.w);
  if (!cut_out && max(texel.x, texel.y) < int(place.z)) {
    uint key = floatBitsToUint(gl_FragCoord.z);
    uint stored;
    if (is_resident(texel, stored) && key > stored) imageAtomicMax(words[push.image], texel, key);
  }
}
