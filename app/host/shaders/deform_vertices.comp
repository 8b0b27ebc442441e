// Morph targets, then the skin, into an instance's own positions and normals.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { DeformPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Joints { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Matrices { mat4 at[]; };

void main() {
  uint vertex = ITEM_INDEX;
  if (vertex >= push.vertex_count) return;
  vec3 position = Vec3s(push.positions).at[vertex];
  vec3 normal = Vec3s(push.normals).at[vertex];

  for (uint target = 0u; target < push.target_count; ++target) {
    float weight = Floats(push.morph_weights).at[target];
    if (weight == 0.0) continue;
    uint delta = target * push.vertex_count + vertex;
    if (push.morph_positions != 0ul) position += weight * Vec3s(push.morph_positions).at[delta];
    if (push.morph_normals != 0ul) normal += weight * Vec3s(push.morph_normals).at[delta];
  }
  if (push.joints != 0ul) {
    uvec2 packed = Joints(push.joints).at[vertex];
    uvec4 joint = uvec4(packed.x & 0xffffu, packed.x >> 16, packed.y & 0xffffu, packed.y >> 16);
    vec4 weight = Vec4s(push.joint_weights).at[vertex];
    Matrices matrices = Matrices(push.joint_matrices);
    mat4 skin = mat4(0.0);
    for (int i = 0; i < 4; ++i) skin += weight[i] * matrices.at[joint[i]];
    position = (skin * vec4(position, 1.0)).xyz;
    mat3 turn = mat3(skin);
    mat3 cofactors = mat3(cross(turn[1], turn[2]), cross(turn[2], turn[0]), cross(turn[0], turn[1]));
    normal = cofactors * normal;
    if (dot(turn[0], cofactors[0]) < 0.0) normal = -normal;
  }
  Vec3s(push.out_positions).at[vertex] = position;
  Vec3s(push.out_normals).at[vertex] = normal;
}
