#version 460
// Marks what points in the host's boxes may look up of the maps that are for them, as mark_pages does for clusters. A workgroup
// a map, a thread a box.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_arrays.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { MarkBoxesPush push; };
#include "maps/mark_box.glsl"

/// What the light reaches of a box: empty, or with a little to spare for hosts that compute positions with other roundings.
Box lit_part(LightRecord light, Box box) {
  vec3 largest = max(abs(box.lo), abs(box.hi));
  float slack = max(largest.x, max(largest.y, largest.z)) * 2e-6;
  box = Box(box.lo - slack, box.hi + slack);
  if (light.type == LightDirectional) return box;
  Box reached = light_box(light);
  float more = light.range_m * 1e-4 + slack;
  return Box(max(box.lo, reached.lo - more), min(box.hi, reached.hi + more));
}

void main() {
  uint map_index = group_index();
  if (map_index >= Counters(push.counters).counters.maps) return;
  FrameRecord frame = Frame(push.frame).record;
  MapRecord map = Maps(frame.maps).v[map_index];
  if (map.receivers != ReceiversInBoxes) return;
  LightRecord light = Lights(frame.lights).v[map.light];
  for (uint i = gl_LocalInvocationIndex; i < push.box_count; i += 64u) {
    Box box = lit_part(light, Boxes(push.boxes).v[i]);
    if (all(lessThanEqual(box.lo, box.hi)) && light_shines_on(light, box)) mark_box(frame, map_index, map, box);
  }
}
