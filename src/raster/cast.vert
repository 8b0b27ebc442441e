#version 460
// A caster's vertex into a shadow view. What is the same for all vertices of the batch comes as instance attributes
// (CasterInstance); the view's tile is cut out of the atlas by clip distances.
#extension GL_GOOGLE_include_directive : require
#include "scene/scene_buffers.glsl"
#include "raster/raster_types.shared.h"
layout(push_constant, scalar) uniform PushBlock { CastPush push; };
layout(constant_id = 0) const bool masked = false;

layout(location = 0) in vec4 row_x;
layout(location = 1) in vec4 row_y;
layout(location = 2) in vec4 row_z;
layout(location = 3) in vec4 row_w;
layout(location = 4) in vec4 tile;      // texels, x, y
layout(location = 5) in uvec4 geometry; // positions, their stride, batch
layout(location = 6) in uvec4 texture_coordinates;

layout(location = 0) out vec2 uv;
layout(location = 1) flat out uint batch_index;
out float gl_ClipDistance[4];

void main() {
  Floats positions = Floats(packUint2x32(geometry.xy));
  uint at = gl_VertexIndex * geometry.z;
  vec4 position = vec4(positions.v[at], positions.v[at + 1], positions.v[at + 2], 1.0);
  vec4 clip = vec4(dot(row_x, position), dot(row_y, position), dot(row_z, position), dot(row_w, position));
  gl_ClipDistance[0] = clip.w - clip.x;
  gl_ClipDistance[1] = clip.w + clip.x;
  gl_ClipDistance[2] = clip.w - clip.y;
  gl_ClipDistance[3] = clip.w + clip.y;
  clip.xy = (clip.xy * tile.x + clip.w * (2.0 * tile.yz + tile.x)) / push.viewport_size - clip.w;
  gl_Position = clip;

  uv = vec2(0.0);
  batch_index = geometry.w;
  if (masked) {
    Floats uvs = Floats(packUint2x32(texture_coordinates.xy));
    uint uv_at = gl_VertexIndex * texture_coordinates.z;
    uv = vec2(uvs.v[uv_at], uvs.v[uv_at + 1]);
  }
}
