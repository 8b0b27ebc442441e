#version 460
// Stores that keep maps in images: each map takes the next free layers of the image whose side is closest to its own; when
// those are taken, of the next coarser one, and when all of these are, of a finer one. The most important lights choose first.
// One workgroup. The host has made sure that there are layers for all.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
#include "maps/map_push.shared.h"
#include "maps/resolution.shared.h"
layout(local_size_x = 256) in;
UMB_ARRAY(Maps, MapRecord, 4);
UMB_ARRAY(LightMapList, LightMaps, 4);
UMB_ARRAY(Images, MapImage, 4);
layout(push_constant, scalar) uniform PushBlock { PlaceMapsPush push; };

shared uint sums[256];
shared uint used_layers[MaxMapImages];

Maps maps;
LightMapList light_maps;
uvec2 lights;   // this thread's, in the order of priority: begin, end

/// The side that suits a map best, whether or not there is such an image. Where pages are backed one by one a map lies in the
/// corner of an image that is no smaller.
uint side_for(MapRecord map) {
  return 1u << (push.whole_images != 0u ? level_of_resolution(float(map.asked)) : uint(findMSB(max(map.asked, 2u) - 1u) + 1));
}

bool may_choose(MapRecord map, MapImage image, bool any_side) {
  uint coarsest = Images(push.images).v[push.image_count - 1u].side;
  return map.image == NoIndex && (any_side || image.side <= max(side_for(map), coarsest));
}

/// Sum over the threads before this one, and over all.
uvec2 sum_threads(uint own) {
  barrier();
  sums[gl_LocalInvocationIndex] = own;
  barrier();
  uvec2 sum = uvec2(0u);
  for (uint i = 0u; i < 256u; ++i) {
    if (i < gl_LocalInvocationIndex) sum.x += sums[i];
    sum.y += sums[i];
  }
  return sum;
}

void place(uint index, uint image_index, uint side, uint layer) {
  MapRecord map = maps.v[index];
  map.image = image_index;
  map.layer = layer;
  if (push.whole_images != 0u) map.asked = side_for(map);
  map.resolution = push.whole_images != 0u ? side : min(map.resolution, side);
  map.pages = push.whole_images != 0u ? 0u : pages_of(map.resolution);
  map.words = page_words_of(map.pages);
  maps.v[index] = map;
}

/// Layers that this thread's maps would take of an image.
uint layers_wanted(MapImage image, bool any_side) {
  uint wanted = 0u;
  for (uint i = lights.x; i < lights.y; ++i) {
    LightMaps own = light_maps.v[Uints(push.priority).v[i]];
    for (uint m = own.first; m < own.first + own.count; ++m)
      if (may_choose(maps.v[m], image, any_side)) wanted += maps.v[m].view_count;
  }
  return wanted;
}

void take_layers(uint image_index, MapImage image, bool any_side, uint next) {
  for (uint i = lights.x; i < lights.y; ++i) {
    LightMaps own = light_maps.v[Uints(push.priority).v[i]];
    for (uint m = own.first; m < own.first + own.count; ++m) {
      MapRecord map = maps.v[m];
      if (!may_choose(map, image, any_side)) continue;
      uint end = next + map.view_count;   // once one does not fit, none does
      if (end <= image.layers) {
        place(m, image_index, image.side, next);
        atomicMax(used_layers[image_index], end);
      }
      next = end;
    }
  }
}

void fill(uint image_index, bool any_side) {
  MapImage image = Images(push.images).v[image_index];
  uint start = used_layers[image_index];   // before anyone takes more
  uint before = sum_threads(layers_wanted(image, any_side)).x;
  take_layers(image_index, image, any_side, start + before);
  barrier();
}

/// A sum over all threads that ends at 2^31.
uint sum_units(uint own) {
  uint thousands = sum_threads(own / 1024u).y;
  return min(thousands, 0x1fffffu) * 1024u + sum_threads(own % 1024u).y;
}

/// Texels of the whole images taken, and what those of the sides asked for would have.
void count_texels() {
  uvec2 units = uvec2(0u);
  for (uint i = lights.x; i < lights.y; ++i) {
    LightMaps own = light_maps.v[Uints(push.priority).v[i]];
    for (uint m = own.first; m < own.first + own.count; ++m) {
      MapRecord map = maps.v[m];
      units += map.view_count * (uvec2(map.resolution, map.asked) * uvec2(map.resolution, map.asked) / PoolUnit);
    }
  }
  uint placed = sum_units(units.x);
  uint asked = sum_units(units.y);
  if (gl_LocalInvocationIndex != 0u) return;
  Counters(push.counters).counters.pool_units = placed;
  Counters(push.counters).counters.pool_units_asked = asked;
}

void main() {
  if (Counters(push.counters).counters.fitted != 0u) return;
  uint thread = gl_LocalInvocationIndex;
  maps = Maps(Frame(push.frame).record.maps);
  light_maps = LightMapList(Frame(push.frame).record.light_maps);
  uint per_thread = (push.light_count + 255u) / 256u;
  lights.x = min(thread * per_thread, push.light_count);
  lights.y = min(lights.x + per_thread, push.light_count);
  if (thread < MaxMapImages) used_layers[thread] = 0u;
  for (uint i = 0u; i < push.image_count; ++i) fill(i, false);
  uint left = 0u;
  for (uint i = lights.x; i < lights.y; ++i) {
    LightMaps own = light_maps.v[Uints(push.priority).v[i]];
    for (uint m = own.first; m < own.first + own.count; ++m) left += uint(maps.v[m].image == NoIndex);
  }
  if (sum_threads(left).y > 0u)
    for (uint i = push.image_count; i > 0u; --i) fill(i - 1u, true);
  if (push.whole_images != 0u) count_texels();
}
