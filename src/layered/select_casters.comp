#version 460
// Which casters which views see, and the draws of each group of views (R3): a caster is left out of a group only when no view
// of the group sees its box. A thread a caster.
#extension GL_GOOGLE_include_directive : require
#include "layered/layered_buffers.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { SelectPush push; };
layout(constant_id = 0) const bool select_all = false;
layout(constant_id = 1) const bool each_view = false;

/// False only if the box lies outside of one clip plane of the view: exact for each plane, with room for rounding.
bool may_see(LayeredViewRecord view, LayeredInstanceRecord instance, vec3 centre, vec3 half_size) {
  vec3 world = vec3(dot(instance.row0, vec4(centre, 1.0)), dot(instance.row1, vec4(centre, 1.0)), dot(instance.row2, vec4(centre, 1.0)));
  mat4 rows = transpose(view.clip_from_world);
  vec4 planes[6] = vec4[6](rows[3] - rows[0], rows[3] + rows[0], rows[3] - rows[1], rows[3] + rows[1], rows[2], rows[3] - rows[2]);
  for (int i = 0; i < 6; ++i) {
    vec3 normal = planes[i].x * instance.row0.xyz + planes[i].y * instance.row1.xyz + planes[i].z * instance.row2.xyz;
    float middle = dot(planes[i].xyz, world) + planes[i].w;
    float reach = dot(abs(normal), half_size);
    float slack = 1e-5 * (dot(abs(planes[i].xyz), abs(world)) + abs(planes[i].w) + reach);
    if (middle + reach < -slack) return false;
  }
  return true;
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= push.caster_count) return;
  LayeredCaster caster = LayeredCasters(push.casters).v[index];
  LayeredBatch batch = LayeredBatches(push.batches).v[caster.batch];
  LayeredInstanceRecord instance = LayeredInstances(push.instances).v[caster.instance];
  vec3 centre = 0.5 * (batch.box_min + batch.box_max);
  vec3 half_size = 0.5 * (batch.box_max - batch.box_min);
  bool always = select_all || instance.first_bone != NoIndex;

  uint words[ViewWords];
  for (uint word = 0u; word < ViewWords; ++word) {
    words[word] = 0u;
    uint end = min(push.view_count, 32u * (word + 1u));
    for (uint view = 32u * word; view < end; ++view)
      if (always || may_see(LayeredViews(push.views).v[view], instance, centre, half_size)) words[word] |= 1u << (view % 32u);
    Uints(push.visible).v[index * ViewWords + word] = words[word];
  }

  uint list = batch.mask != NoIndex && push.list_count > 1u ? 1u : 0u;
  if (push.list_count == 4u && instance.handedness < 0.0) list += 2u;
  for (uint g = 0u; g < push.group_count; ++g) {
    LayeredGroup group = LayeredGroups(push.groups).v[g];
    uint seen = 0u;
    for (uint view = group.first_view; view < group.first_view + group.view_count; ++view)
      seen += (words[view / 32u] >> (view % 32u)) & 1u;
    if (seen == 0u) continue;
    uint row = g * push.list_count + list;
    uint at = row * push.caster_count + atomicAdd(LayeredCounts(push.counts).v[row].x, 1u);
    uint drawn_instances = push.instance_per_view == 0u ? 1u : each_view ? seen : group.view_count;
    uint stride = push.instance_per_view == 0u ? 1u : MaxLayeredViews;
    if (push.draws != 0ul)
      LayeredDraws(push.draws).v[at] = LayeredDraw(3u * batch.triangle_count, drawn_instances, batch.first_index, 0, index * stride);
    if (push.listed != 0ul) Uints(push.listed).v[at] = index;
  }
}
