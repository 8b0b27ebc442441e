// Exposure from the histogram: the mean stop between two percentiles becomes middle grey. One thread; 256 bins.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "exposure.glsl"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { FramePush push; };

// Pixels that no light reaches say nothing about the right exposure, nor do the lamps themselves.
const float low_percentile = 0.5;
const float high_percentile = 0.98;
const float middle_grey = 0.2;

void main() {
  Frame frame = Frame(push.frame);
  Counters counters = Counters(frame.data.counters);
  uint total = 0u;
  for (uint bin = 1u; bin < 256u; ++bin) total += counters.data.luminance_histogram[bin];
  float low = low_percentile * float(total), high = high_percentile * float(total);
  float below = 0.0, weights = 0.0, stops = 0.0;
  for (uint bin = 1u; bin < 256u; ++bin) {
    float count = float(counters.data.luminance_histogram[bin]);
    float inside = max(min(below + count, high) - max(below, low), 0.0);
    weights += inside;
    stops += inside * bin_stop(bin);
    below += count;
  }
  counters.data.exposure = weights > 0.0 ? middle_grey / exp2(stops / weights) : 1.0;
}
