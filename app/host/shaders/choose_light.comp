// The light whose maps are shown: the one asked for, else of those with maps the one that most clusters list. One group.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#define UMBRAGE_SET 2
#define UMBRAGE_DEBUG
#include "umbrage/shaders/umbrage.glsl"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { ShowPush push; };

shared uint most, chosen;

void main() {
  Frame frame = Frame(push.frame);
  Subject subject = Subject(push.subject);
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  uint thread = gl_LocalInvocationIndex, threads = gl_WorkGroupSize.x;
  if (thread == 0u) {
    most = 0u;
    chosen = NoLight;
  }
  for (uint i = thread; i < frame.data.light_count; i += threads) subject.uses[i] = GpuLightUse(0u, 0u);
  memoryBarrierBuffer();
  barrier();

  uint clusters = umbrage_cluster_count(shadows);
  for (uint c = thread; c < clusters; c += threads) {
    UmbrageCluster cluster = umbrage_debug_cluster(shadows, c);
    for (uint i = 0u; i < cluster.count; ++i) {
      UmbrageLight light = umbrage_light(shadows, cluster, i);
      if (umbrage_debug_light_maps(shadows, light.index).y == 0u) continue;
      atomicAdd(subject.uses[light.host_index].clusters, 1u);
      atomicExchange(subject.uses[light.host_index].slot, light.index);
    }
  }
  memoryBarrierBuffer();
  barrier();

  for (uint i = thread; i < frame.data.light_count; i += threads) {
    if (push.light == NoLight || push.light == i) atomicMax(most, atomicOr(subject.uses[i].clusters, 0u));
  }
  barrier();
  for (uint i = thread; i < frame.data.light_count; i += threads) {
    if (push.light != NoLight && push.light != i) continue;
    if (most > 0u && atomicOr(subject.uses[i].clusters, 0u) == most) atomicMin(chosen, i);
  }
  barrier();
  if (thread > 0u) return;
  subject.data.light = chosen;
  subject.data.clusters = most;
  if (chosen != NoLight) subject.data.slot = atomicOr(subject.uses[chosen].slot, 0u);
}
