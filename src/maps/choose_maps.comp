#version 460
// O2, O8: from what is asked of each light to its maps, numbered by light and finest first, and to their places in the page
// words and receiver masks. One workgroup: lights are few. Runs again in each round in which the budget is fitted.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
#include "gpu/groups.glsl"
layout(local_size_x = 256) in;

shared uint maps_before[256];
shared uint words_before[256];
shared uint views_before[256];

/// What one light takes.
struct Share {
  uint maps;
  uint words;
  uint views;
};

struct Limits {
  uint maps_per_light;
  uint shift;             // on top of the light's own
};

uint resolution_of_place(LightRecord light, LightRequest request, uint place, uint shift) {
  if (has_levels(light)) return Views(push.views).v[light.first_view + SunFirstWindow + place].resolution;
  if (!has_flag(MapsExact)) return backed_resolution(1u << level_of_place(place), backing().x);   // places are shifted already
  return exact_resolution(uintBitsToFloat(request.buckets[place]) / float(1u << shift), backing().x);
}

/// Places at which a map begins. Levels: halving moves a level to the next place, the last ones meet at the coarsest; of too
/// many the finest stay. Buckets: one for each resolution that differs from the one before.
uint kept_places(LightRecord light, LightRequest request, uint shift, uint most) {
  if (has_levels(light)) {
    // As many as place_levels has left, unless tables are short; the last shift is to the coarsest at once.
    if (shift == MaxShift) shift = SunPlaces;
    return sun_kept_places(sun_shifted_places(request.places, shift), most < push.maps_per_light ? most : MaxMapsPerLight);
  }
  uint kept = 0u;
  if (has_flag(MapsExact)) {
    uint before = 0u;
    for (uint place = 0u; place < push.maps_per_light; ++place) {
      if ((request.places & (1u << place)) == 0u) continue;
      uint resolution = resolution_of_place(light, request, place, shift);
      if (resolution != before && bitCount(kept) < most) kept |= 1u << place;
      before = resolution;
    }
    return kept;
  }
  uint last = 1u << place_of_level(MinLevel);
  uint shifted = request.places << shift;
  shifted = (shifted & (last - 1u)) | (shifted >= last ? last : 0u);
  while (shifted != 0u && bitCount(kept) < most) {
    kept |= shifted & (0u - shifted);
    shifted &= shifted - 1u;
  }
  return kept;
}

/// Whom a light's whole map is for; ReceiversInSight: it has none.
uint receivers_of_whole(uint slot) {
  FrameCounters counters = Counters(push.counters).counters;
  if (has_flag(MapsAllLights) || counters.all_lights_used != 0u || counters.clusters_found > counters.clusters) return ReceiversAnywhere;
  return (Uints(push.used).v[slot] & LightReachesBoxes) != 0u ? ReceiversInBoxes : ReceiversInSight;
}

uint whole_resolution(LightRecord light, uint shift) {
  return backed_resolution(max(min(WholeResolution, light.resolution) >> shift, 1u << MinLevel), backing().x);
}

uint light_shift(uint slot, Limits limits) {
  return min((push.round > 0u ? LightMapList(Frame(push.frame).record.light_maps).v[slot].shift : 0u) + limits.shift, MaxShift);
}

Share share_of(uint slot, Limits limits) {
  Share share = Share(0u, 0u, 0u);
  LightRecord light = Lights(Frame(push.frame).record.lights).v[slot];
  if (light.type == NoIndex || light.view_count == 0u) return share;
  LightRequest request = Requests(push.requests).v[slot];
  uint shift = light_shift(slot, limits);
  uint kept = kept_places(light, request, shift, limits.maps_per_light);
  for (uint left = kept; left != 0u; left &= left - 1u)
    share.words += light.view_count * page_words_of(pages_of(resolution_of_place(light, request, uint(findLSB(left)), shift)));
  share.maps = bitCount(kept);
  if (receivers_of_whole(slot) != ReceiversInSight) {
    ++share.maps;
    share.words += light.view_count;
  }
  share.views = share.maps * light.view_count;
  return share;
}

/// Totals over all lights; every thread keeps what lies before its own.
Share sum_shares(uint begin, uint end, Limits limits, out Share before) {
  Share own = Share(0u, 0u, 0u);
  for (uint slot = begin; slot < end; ++slot) {
    Share share = share_of(slot, limits);
    own.maps += share.maps;
    own.words += share.words;
    own.views += share.views;
  }
  uint thread = gl_LocalInvocationIndex;
  barrier();
  maps_before[thread] = own.maps;
  words_before[thread] = own.words;
  views_before[thread] = own.views;
  barrier();
  Share total = Share(0u, 0u, 0u);
  for (uint i = 0u; i < 256u; ++i) {
    if (i == thread) before = total;
    total.maps += maps_before[i];
    total.words += words_before[i];
    total.views += views_before[i];
  }
  return total;
}

void write_maps(uint slot, Limits limits, inout Share at) {
  FrameRecord frame = Frame(push.frame).record;
  LightMaps maps = LightMaps(at.maps, 0u, NoIndex, light_shift(slot, limits), 0u);
  LightRecord light = Lights(frame.lights).v[slot];
  if (light.type != NoIndex && light.view_count > 0u) {
    LightRequest request = Requests(push.requests).v[slot];
    maps.kept = kept_places(light, request, maps.shift, limits.maps_per_light);
    uint others = receivers_of_whole(slot);
    maps.count = bitCount(maps.kept) + uint(others != ReceiversInSight);
    if (others != ReceiversInSight) maps.whole = at.maps + maps.count - 1u;
    uint left = maps.kept;
    for (uint i = 0u; i < maps.count; ++i) {
      bool is_whole = left == 0u;
      uint place = is_whole ? 0u : uint(findLSB(left));
      uint resolution = is_whole ? whole_resolution(light, maps.shift) : resolution_of_place(light, request, place, maps.shift);
      uint first_view = light.first_view + (has_levels(light) && !is_whole ? SunFirstWindow + place : 0u);
      uint pages = pages_of(resolution);
      uint words = page_words_of(pages);
      Maps(frame.maps).v[at.maps] = MapRecord(slot, first_view, light.view_count, light.views, resolution, pages, words, at.words, at.views,
                                              is_whole && others == ReceiversAnywhere ? (1u << light.view_count) - 1u : 0u,
                                              is_whole ? others : ReceiversInSight, light.light_mask, NoIndex, 0u, resolution, 0u);
      ++at.maps;
      at.words += words * light.view_count;
      at.views += light.view_count;
      left &= left - 1u;
    }
  }
  LightMapList(frame.light_maps).v[slot] = maps;
}

void main() {
  if (push.round > 0u && Counters(push.counters).counters.fitted != 0u) return;   // the dispatches of this round are empty
  uint thread = gl_LocalInvocationIndex;
  uint per_thread = (push.light_slots + 255u) / 256u;
  uint begin = min(thread * per_thread, push.light_slots);
  uint end = min(begin + per_thread, push.light_slots);
  uint map_capacity = Frame(push.frame).record.map_capacity;
  Limits limits = Limits(push.maps_per_light, 0u);
  Share before;
  Share total = sum_shares(begin, end, limits, before);
  uint maps_found = total.maps;
  uint words_found = total.words;
  uint views_found = total.views;
  // Too many for the tables: fewer maps a light (finer ones answer for coarser), then coarser ones. Sized by the host so
  // that one map of the coarsest level always has room.
  while (total.maps > map_capacity || total.views > push.receiver_capacity || total.words > push.word_capacity) {
    bool too_many = total.maps > map_capacity || total.views > push.receiver_capacity;
    if (too_many && limits.maps_per_light > 1u) --limits.maps_per_light;
    else if (limits.shift < MaxShift) ++limits.shift;
    else if (limits.maps_per_light > 1u) --limits.maps_per_light;
    else break;
    total = sum_shares(begin, end, limits, before);
  }
  Share at = before;
  for (uint slot = begin; slot < end; ++slot) write_maps(slot, limits, at);
  if (thread != 0u) return;
  if (push.round == 0u) {
    Counters(push.counters).counters.maps_found = maps_found;
    Counters(push.counters).counters.page_words_found = words_found;
    Counters(push.counters).counters.receiver_views_found = views_found;
  }
  Counters(push.counters).counters.maps = total.maps;
  Counters(push.counters).counters.page_words = total.words;
  Counters(push.counters).counters.receiver_views = total.views;
  Counters(push.counters).counters.pages = 0u;
  Counters(push.counters).counters.pool_units = 0u;
  uvec3 groups = groups_for(total.maps);
  uvec3 word_groups = groups_for((total.words + 63u) / 64u);
  for (int i = 0; i < 3; ++i) {
    Counters(push.counters).counters.map_groups[i] = groups[i];
    Counters(push.counters).counters.fit_map_groups[i] = groups[i];
    Counters(push.counters).counters.fit_pair_groups[i] = Counters(push.counters).counters.pair_groups[i];
    Counters(push.counters).counters.fit_word_groups[i] = word_groups[i];
  }
}
