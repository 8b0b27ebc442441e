// Vertices of the G-buffer and of blended surfaces: pulled by address, transformed relative to the eye.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"

layout(constant_id = 2) const uint reads = ReadsAll;
layout(push_constant, scalar) uniform Push { FramePush push; };

layout(location = 0) out vec3 offset_ws;
layout(location = 1) out vec3 normal_ws;
layout(location = 2) out vec4 tangent_ws;
layout(location = 3) out vec4 uv_sets;
layout(location = 4) out vec4 color;
layout(location = 5) flat out uint material_index;

invariant gl_Position;

void main() {
  Frame frame = Frame(push.frame);
  GpuInstance instance = Instances(frame.data.instances).at[gl_InstanceIndex];
  GpuPrimitive primitive = Primitives(frame.data.primitives).at[instance.primitive];
  vec4 x = instance.world_from_mesh[0], y = instance.world_from_mesh[1], z = instance.world_from_mesh[2];

  vec4 position = vec4(Vec3s(instance.positions).at[gl_VertexIndex], 1.0);
  offset_ws = vec3(dot(x, position), dot(y, position), dot(z, position)) - frame.data.eye_ws;
  gl_Position = frame.data.clip_from_offset * vec4(offset_ws, 1.0);

  // Cofactors are the inverse transpose times the determinant; its sign undoes the flip of mirrored instances.
  vec3 normal = Vec3s(instance.normals).at[gl_VertexIndex];
  vec3 yz = cross(y.xyz, z.xyz), zx = cross(z.xyz, x.xyz), xy = cross(x.xyz, y.xyz);
  float mirror = dot(x.xyz, yz) < 0.0 ? -1.0 : 1.0;
  normal_ws = vec3(dot(yz, normal), dot(zx, normal), dot(xy, normal)) * mirror;
  float size = length(normal_ws);
  normal_ws = size > 0.0 ? normal_ws / size : vec3(0.0);

  tangent_ws = vec4(0.0);
  if ((reads & ReadsNormalTexture) != 0u && primitive.tangents != 0ul && instance.deformed == 0u) {
    vec4 tangent = Vec4s(primitive.tangents).at[gl_VertexIndex];
    vec3 moved = vec3(dot(x.xyz, tangent.xyz), dot(y.xyz, tangent.xyz), dot(z.xyz, tangent.xyz));
    tangent_ws = vec4(moved / max(length(moved), 1e-30), tangent.w * mirror);
  }
  uv_sets = vec4(0.0);
  if ((reads & ReadsTextures) != 0u && primitive.uv_0 != 0ul) uv_sets.xy = Vec2s(primitive.uv_0).at[gl_VertexIndex];
  if ((reads & ReadsTextures) != 0u && primitive.uv_1 != 0ul) uv_sets.zw = Vec2s(primitive.uv_1).at[gl_VertexIndex];
  color = vec4(1.0);
  if ((reads & ReadsVertexColors) != 0u && primitive.colors != 0ul) color = Vec4s(primitive.colors).at[gl_VertexIndex];
  material_index = primitive.material;
}
