// The cluster under the picture's centre, or under the nearest pixel that a point or spot light reaches, and the light that
// is brightest there. One group.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#include "brightest.glsl"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { ShowPush push; };

// Pixels are tried on a grid around the centre; its cells are numbered in 16 bits.
const int grid_side = 129;
shared uint nearest;

ivec2 pixel_of_cell(ivec2 size, uint cell) {
  ivec2 from_centre = ivec2(cell % uint(grid_side), cell / uint(grid_side)) - grid_side / 2;
  return size / 2 + from_centre * max(max(size.x, size.y) / (grid_side - 1), 1);
}

void main() {
  Frame frame = Frame(push.frame);
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  ivec2 size = ivec2(frame.data.width, frame.data.height);
  if (gl_LocalInvocationIndex == 0u) nearest = NoLight;
  barrier();
  for (uint cell = gl_LocalInvocationIndex; cell < uint(grid_side * grid_side); cell += gl_WorkGroupSize.x) {
    Point p = point_at(frame, pixel_of_cell(size, cell));
    if (!p.exists) continue;
    ivec2 steps = ivec2(cell % uint(grid_side), cell / uint(grid_side)) - grid_side / 2;
    uint key = uint(steps.x * steps.x + steps.y * steps.y) << 16u | cell;
    if (key >= nearest) continue;
    UmbrageCluster cluster = umbrage_cluster(shadows, p.pixel, p.depth);
    if (cluster.index == UmbrageNoIndex) continue;
    if (brightest(frame, shadows, cluster, p, push.light, true) != NoLight) atomicMin(nearest, key);
  }
  barrier();
  if (gl_LocalInvocationIndex > 0u) return;

  Subject subject = Subject(push.subject);
  subject.data.light = NoLight;
  subject.data.box_low = vec3(1.0);
  subject.data.box_high = vec3(0.0);
  if (nearest == NoLight) return;
  Point p = point_at(frame, pixel_of_cell(size, nearest & 0xffffu));
  UmbrageCluster cluster = umbrage_cluster(shadows, p.pixel, p.depth);
  UmbrageLight light = umbrage_light(shadows, cluster, brightest(frame, shadows, cluster, p, push.light, true));
  subject.data.light = light.host_index;
  subject.data.slot = light.index;
  subject.data.light_ws = light.position_ws;
  vec3 low, high;
  umbrage_cluster_box(shadows, cluster.index, low, high);
  subject.data.box_low = low;
  subject.data.box_high = high;
}
