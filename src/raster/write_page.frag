#version 460
// A fragment → its texel in the page pool, found through the page bits; no attachment.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#include "raster/page_buffers.glsl"
layout(push_constant, scalar) uniform PushBlock { CastPagePush push; };
layout(constant_id = 0) const bool masked = false;
layout(set = 1, binding = 0) uniform sampler2D masks[];
layout(location = 0) in vec2 uv;
layout(location = 1) flat in uvec4 place;           // batch, first word, resolution, unused

void main() {
  bool cut_out = false;
  if (masked) {
    BatchRecord batch = Batches(push.batches).v[place.x];
    cut_out = batch.mask != NoIndex && texture(masks[nonuniformEXT(batch.mask)], uv).a * batch.alpha_factor < batch.alpha_cutoff;
  }
  uvec2 texel = uvec2(gl_FragCoord.xy);
  // Branches, not discard: what is discarded may still load, from addresses that are nobody's.
  if (!cut_out && max(texel.x, texel.y) < place.z) {
    MapRecord map;
    map.resolution = place.z;
    map.pages = pages_of(place.z);
    map.first_word = place.y;
    map.words = 0u;
    Frame frame = Frame(push.frame);
    Pool pool = pool_of(frame);
    uint origin = page_origin(pool, map, 0u, texel);
    if (origin != NoTexel) {
      uint at = origin + texel_in_page(texel, place.z);
      uint key = floatBitsToUint(gl_FragCoord.z);
      // Most of what is drawn lies behind something: a look costs less than an atomic.
      if (key > pool.texels.v[at]) atomicMax(pool.texels.v[at], key);
    }
  }
}
