// Adds the picture's luminances to the histogram. Background does not count.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#include "exposure.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform Push { FramePush push; };

const int pixels_per_side = 2;  // Per thread, so that fewer groups merge their counts.
shared uint counts[256];

void main() {
  Frame frame = Frame(push.frame);
  counts[gl_LocalInvocationIndex] = 0u;
  barrier();
  ivec2 first = ivec2(gl_GlobalInvocationID.xy) * pixels_per_side;
  ivec2 end = min(first + pixels_per_side, ivec2(frame.data.width, frame.data.height));
  for (int y = first.y; y < end.y; ++y) {
    for (int x = first.x; x < end.x; ++x) {
      vec4 color = imageLoad(color_target, ivec2(x, y));
      if (color.a > 0.0) atomicAdd(counts[luminance_bin(luminance(color.rgb))], 1u);
    }
  }
  barrier();
  uint count = counts[gl_LocalInvocationIndex];
  if (count > 0u) {
    atomicAdd(Counters(frame.data.counters).data.luminance_histogram[gl_LocalInvocationIndex], count);
  }
}
