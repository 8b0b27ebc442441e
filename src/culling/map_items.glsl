// What count_items and write_items share: the map of the workgroup, and which of its views a batch goes to.
#include "clusters/cluster_buffers.glsl"
#include "culling/culling_types.shared.h"
#include "culling/receivers.shared.h"

UMB_ARRAY(Views, ShadowView, 4);
UMB_ARRAY(Maps, MapRecord, 4);
layout(push_constant, scalar) uniform PushBlock { ItemPush push; };

#include "culling/walk.glsl"

layout(constant_id = 0) const uint mode = CullLightVolume;
/// NodesByLight, …
layout(constant_id = 1) const uint node_test = 0u;

MapRecord map;
LightRecord light;
ShadowView first_view;
MapReceivers receivers;
float texel_error;   // of the casters, at depth 1

void load_map(uint index) {
  Frame frame = Frame(push.frame);
  map = Maps(frame.record.maps).v[index];
  light = Lights(frame.record.lights).v[map.light];
  first_view = Views(frame.record.views).v[map.first_view];
  texel_error = frame.record.caster_error * unit_texel_m(first_view, map.kind, map.resolution);
  if (mode >= CullProjectionMap)
    receivers = receivers_of(map, frame.record.projection, frame.record.receiver_depth, frame.record.receiver_grid, mode);
}

/// Whether the map has a batch: its instance casts for the light, and the batch is of the level of detail that suits the map.
bool is_drawn(uint caster_index) {
  CasterRecord caster = Casters(push.casters).v[caster_index];
  if (caster.instance == NoIndex) return false;
  InstanceRecord instance = Instances(push.instances).v[caster.instance];
  if ((instance.light_mask & map.light_mask) == 0u) return false;
  float error_ws = texel_error * least_depth(first_view, map.kind, instance.box.lo, instance.box.hi);
  return is_at_level(Batches(push.batches).v[caster.batch], instance, error_ws);
}

uint views_of(Box box, uint height, uint i) {
  if (box_is_empty(box) || !light_meets_box(light, box)) return 0u;
  if (height == 0u && !is_drawn(Uints(push.order).v[i])) return 0u;
  if (height > 1u || (height == 1u && node_test == NodesByLight)) return 1u;
  Box grown = with_slack(box, first_view.origin, height == 0u ? BoxSlack : NodeSlack);
  return faces_to_draw(map, first_view, receivers, grown, height > 0u && node_test == NodesByView ? min(mode, CullViewMask) : mode);
}
