#version 460
// O8: the histogram of the resolutions that a light's clusters ask for; each bucket keeps its largest.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;

void main() {
  uint pair = global_index(64u);
  if (pair >= pair_count()) return;
  uint bits = Uints(push.pair_requests).v[pair];
  if (bits == 0u) return;
  uint slot = Uints(Frame(push.frame).record.cluster_lights).v[pair];
  float finest = uintBitsToFloat(Requests(push.requests).v[slot].finest);
  uint bucket = bucket_of_request(uintBitsToFloat(bits), finest, push.maps_per_light, !has_flag(MapsLinearBuckets));
  if (Requests(push.requests).v[slot].buckets[bucket] < bits) atomicMax(Requests(push.requests).v[slot].buckets[bucket], bits);
  uint place = 1u << bucket;
  if ((Requests(push.requests).v[slot].places & place) == 0u) atomicOr(Requests(push.requests).v[slot].places, place);
}
