#version 460
// Holds what the marked pages need against the pool. When it is short, every light is halved s times, s the least with which
// all fit, and the most important ones once less while there is room. The rounds that follow count what that really needs.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
#include "gpu/groups.glsl"
layout(local_size_x = 256) in;

shared float sums[256];

/// The estimate knows nothing of filters that reach across pages.
const float spare = 1.1;

float demand(uint slot, uint shift) { return float(Uints(push.demand).v[slot * (MaxShift + 1u) + shift]) * spare; }

/// Sum over the threads; `before`: over those before this one.
float sum_threads(float own, out float before) {
  barrier();
  sums[gl_LocalInvocationIndex] = own;
  barrier();
  float total = 0.0;
  for (uint i = 0u; i < 256u; ++i) {
    if (i == gl_LocalInvocationIndex) before = total;
    total += sums[i];
  }
  return total;
}

void choose_shifts(uint begin, uint end) {
  float capacity = float(push.capacity_units);
  float before;
  float total = 0.0;
  uint shift = 0u;
  for (; shift <= MaxShift; ++shift) {
    float own = 0.0;
    for (uint i = begin; i < end; ++i) own += demand(Uints(push.priority).v[i], shift);
    total = sum_threads(own, before);
    if (total <= capacity) break;
  }
  shift = min(shift, MaxShift);
  // What one halving less costs, the most important lights first.
  float own = 0.0;
  for (uint i = begin; i < end && shift > 0u; ++i) own += demand(Uints(push.priority).v[i], shift - 1u) - demand(Uints(push.priority).v[i], shift);
  sum_threads(own, before);
  float room = capacity - total - before;
  for (uint i = begin; i < end; ++i) {
    uint slot = Uints(push.priority).v[i];
    if (shift > 0u) room -= demand(slot, shift - 1u) - demand(slot, shift);
    LightMapList(Frame(push.frame).record.light_maps).v[slot].shift = shift > 0u && room >= 0.0 ? shift - 1u : shift;
  }
}

/// Stores of images: halvings, begun ones too, of the map whose image falls shortest of what it asked for.
uint halvings_of_images(LightMaps maps) {
  uint most = 0u;
  for (uint m = maps.first; m < maps.first + maps.count; ++m) {
    MapRecord map = Maps(Frame(push.frame).record.maps).v[m];
    uint halvings = 0u;
    while (map.asked > map.resolution << halvings) ++halvings;
    most = max(most, halvings);
  }
  return most;
}

/// For the statistics.
void report_shifts(uint begin, uint end) {
  uint shifted = 0u;
  for (uint i = begin; i < end; ++i) {
    uint slot = Uints(push.priority).v[i];
    LightMaps maps = LightMapList(Frame(push.frame).record.light_maps).v[slot];
    uint shift = maps.shift + halvings_of_images(maps);
    if (shift == 0u || maps.count == 0u) continue;
    Uints(push.used).v[slot] |= shift << LightShiftAt;
    ++shifted;
  }
  if (shifted > 0u) atomicAdd(Counters(push.counters).counters.lights_shifted, shifted);
}

void main() {
  if (Counters(push.counters).counters.fitted != 0u) return;
  uint thread = gl_LocalInvocationIndex;
  uint units = Counters(push.counters).counters.pool_units;
  uint pages = Counters(push.counters).counters.pages;
  barrier();
  bool fits = units <= push.capacity_units;
  if (thread == 0u) {
    if (push.round == 0u) {
      Counters(push.counters).counters.pages_requested = pages;
      if (!has_flag(MapsWholeImages)) Counters(push.counters).counters.pool_units_asked = units;
    }
    if (fits) {
      uvec3 groups = groups_for((units + ClearUnits - 1u) / ClearUnits);
      Counters(push.counters).counters.fitted = 1u;
      for (int i = 0; i < 3; ++i) {
        Counters(push.counters).counters.clear_groups[i] = groups[i];
        Counters(push.counters).counters.fit_map_groups[i] = 0u;
        Counters(push.counters).counters.fit_pair_groups[i] = 0u;
        Counters(push.counters).counters.fit_word_groups[i] = 0u;
      }
    }
  }
  uint per_thread = (push.light_count + 255u) / 256u;
  uint begin = min(thread * per_thread, push.light_count);
  uint end = min(begin + per_thread, push.light_count);
  if (fits) {
    report_shifts(begin, end);
    return;
  }
  if (push.round == 0u) {
    choose_shifts(begin, end);
    return;
  }
  for (uint i = begin; i < end; ++i) {
    uint slot = Uints(push.priority).v[i];
    uint shift = LightMapList(Frame(push.frame).record.light_maps).v[slot].shift;
    LightMapList(Frame(push.frame).record.light_maps).v[slot].shift = push.round == 1u ? min(shift + 1u, MaxShift) : MaxShift;
  }
}
