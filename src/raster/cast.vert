#version 460
// A caster's vertex into a shadow view. Traditional: the pass holds one view and nothing else. Multi-draw: instance index and
// view mask choose the view (O12), whose tile is cut out of the atlas by clip distances.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "raster/raster_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { CastPush push; };
layout(constant_id = 0) const bool one_view = false;
layout(constant_id = 1) const bool masked = false;
UMB_ARRAY(Views, ShadowView, 4);
UMB_ARRAY(Pairs, CasterPair, 4);

layout(location = 0) out vec2 uv;
layout(location = 1) flat out uint batch_index;
out float gl_ClipDistance[4];

void main() {
  uint caster_index = gl_InstanceIndex;
  uint view_index = push.view;
  if (!one_view) {
    CasterPair pair = Pairs(push.pairs).v[gl_InstanceIndex >> 3];
    caster_index = pair.caster;
    view_index = Lights(push.lights).v[pair_light(pair)].first_view + nth_set_bit(pair_mask(pair), gl_InstanceIndex & 7);
  }
  CasterRecord caster = Casters(push.casters).v[caster_index];
  InstanceRecord instance = Instances(push.instances).v[caster.instance];
  Floats positions = Floats(instance.positions);
  uint at = gl_VertexIndex * instance.position_stride;
  vec4 position = vec4(positions.v[at], positions.v[at + 1], positions.v[at + 2], 1.0);
  vec3 world = vec3(dot(instance.row0, position), dot(instance.row1, position), dot(instance.row2, position));
  ShadowView view = Views(push.views).v[view_index];
  vec4 clip = view_clip_position(view, world);

  gl_ClipDistance[0] = clip.w - clip.x;
  gl_ClipDistance[1] = clip.w + clip.x;
  gl_ClipDistance[2] = clip.w - clip.y;
  gl_ClipDistance[3] = clip.w + clip.y;
  // A map may be smaller than its tile (LightDesc::max_resolution).
  vec2 area = one_view ? vec2(float(push.tile_resolution)) : push.atlas_size;
  vec2 first_texel = one_view ? vec2(0.0) : vec2(view.atlas_x, view.atlas_y);
  clip.xy = (clip.xy * float(view.resolution) + clip.w * (2.0 * first_texel + float(view.resolution))) / area - clip.w;
  gl_Position = clip;
  uv = vec2(0.0);
  batch_index = caster.batch;
  if (masked) {
    Floats uvs = Floats(instance.uvs);
    uint uv_at = gl_VertexIndex * instance.uv_stride;
    uv = vec2(uvs.v[uv_at], uvs.v[uv_at + 1]);
  }
}
