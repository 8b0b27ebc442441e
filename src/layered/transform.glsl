// A vertex in the world, by the chapter's vertex shaders. Every writer computes the same bits: `precise`, in this order.
#include "layered/layered_buffers.glsl"
layout(constant_id = 0) const uint vertex_form = 1u;
layout(constant_id = 1) const uint cull_faces = 0u;
layout(constant_id = 2) const bool cull_frustum = false;
layout(constant_id = 3) const bool each_view = false;   // casters go only to the views that see their box

vec3 fetch_vec3(uint64_t address, uint index) {
  Floats values = Floats(address);
  return vec3(values.v[3u * index], values.v[3u * index + 1u], values.v[3u * index + 2u]);
}

vec3 rotate(LayeredInstanceRecord instance, vec3 v) {
  return vec3(dot(instance.row0.xyz, v), dot(instance.row1.xyz, v), dot(instance.row2.xyz, v));
}

LayeredInstanceRecord instance_of(LayeredPush scene, uint caster) {
  if (vertex_form == VerticesSimple) return LayeredInstances(scene.instances).v[0];
  return LayeredInstances(scene.instances).v[LayeredCasters(scene.casters).v[caster].instance];
}

/// Sum of what the vertex's bones make of a point (w = 1) or a direction (w = 0).
vec3 skinned(LayeredPush scene, uint first_bone, uint vertex, vec4 point) {
  LayeredSkinRecord skin = Skins(scene.skins).v[vertex];
  Rows rows = Rows(scene.bones);
  if (vertex_form == VerticesSkinnedMat3) point.w = 0.0;
  precise vec3 sum = vec3(0.0);
  for (uint i = 0u; i < 4u; ++i) {
    uint bone = (skin.bones >> (8u * i)) & 0xffu;
    if (bone == NoBone) continue;
    uint at = 3u * (first_bone + bone);
    precise vec3 moved = vec3(dot(rows.v[at], point), dot(rows.v[at + 1u], point), dot(rows.v[at + 2u], point));
    sum += moved * skin.weights[i];
  }
  return sum;
}

vec3 world_position(LayeredPush scene, LayeredInstanceRecord instance, uint vertex) {
  precise vec4 position = vec4(fetch_vec3(scene.positions, vertex), 1.0);
  bool is_skinned = vertex_form >= VerticesSkinned && instance.first_bone != NoIndex;
  if (is_skinned) position.xyz = skinned(scene, instance.first_bone, vertex, position);
  if (is_skinned && vertex_form == VerticesSkinnedMat3) return position.xyz;
  precise vec3 world = vec3(dot(instance.row0, position), dot(instance.row1, position), dot(instance.row2, position));
  return world;
}

vec3 world_normal(LayeredPush scene, LayeredInstanceRecord instance, uint vertex) {
  if (scene.normals == 0ul) return vec3(0.0);
  vec3 normal = fetch_vec3(scene.normals, vertex);
  bool is_skinned = vertex_form >= VerticesSkinned && instance.first_bone != NoIndex;
  if (is_skinned) normal = skinned(scene, instance.first_bone, vertex, vec4(normal, 0.0));
  // The cofactor matrix: right under any scale, mirrored or not.
  vec3 x = instance.row0.xyz, y = instance.row1.xyz, z = instance.row2.xyz;
  return instance.handedness * vec3(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
}

vec2 texture_coordinates(LayeredPush scene, uint vertex) {
  if (scene.uvs == 0ul) return vec2(0.0);
  Floats values = Floats(scene.uvs);
  return vec2(values.v[2u * vertex], values.v[2u * vertex + 1u]);
}

/// Clip position in the view, before it is moved to its area of the layer.
vec4 view_clip(LayeredViewRecord view, vec3 world) {
  precise vec4 clip = view.clip_from_world * vec4(world, 1.0);
  return clip;
}
