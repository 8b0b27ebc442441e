// What the writers of the page pool read and write, by address, and where a block of texels lies in the pool.
#include "scene/scene_buffers.glsl"
#include "raster/raster_types.shared.h"

UMB_ARRAY(Maps, MapRecord, 4);
UMB_ARRAY(Views, ShadowView, 4);
UMB_ARRAY(Items, CasterItem, 4);
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Frame { FrameRecord v; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ItemCounts { DrawCounts v; };

const uint NoTexel = 0xffffffffu;

/// What a writer reads of a frame again and again.
struct Pool {
  Uints texels;            // depth keys
  Uints page_bits;
  Uints page_first;
  Uints texel_bits;        // which texels are looked up (texel_word)
  Uints receiver_depth;
  uint receiver_grid;
};

Pool pool_of(Frame frame) {
  return Pool(Uints(frame.v.pool), Uints(frame.v.page_bits), Uints(frame.v.page_first), Uints(frame.v.texel_bits),
              Uints(frame.v.receiver_depth), frame.v.receiver_grid);
}

/// False when in every cell of the receiver grid that texels first … last touch, all receivers lie in front of `nearest`, a
/// depth key. Exact: keys of a view are in the order of its depths.
bool receivers_see(Pool pool, MapRecord map, uint view, ivec2 first, ivec2 last, float near_m, float nearest) {
  if (map.receivers == ReceiversAnywhere) return true;
  uint side = pool.receiver_grid;
  CellRect cells = cells_of_texels(first, last, side, map.resolution);
  if ((cells.last.x - cells.first.x + 1) * (cells.last.y - cells.first.y + 1) > 64) return true;
  // A hair nearer: the key was rounded.
  float depth = (map.kind == ViewsOrtho ? 1.0 - nearest : near_m / nearest) * (1.0 - 1e-5) - (map.kind == ViewsOrtho ? 1e-5 : 0.0);
  uint row = ((map.first_receiver + view) * side + uint(cells.first.y)) * side;
  for (int y = cells.first.y; y <= cells.last.y; ++y) {
    for (int x = cells.first.x; x <= cells.last.x; ++x) {
      float farthest = uintBitsToFloat(pool.receiver_depth.v[row + uint(x)]);
      if (farthest > 0.0 && farthest >= depth) return true;
    }
    row += side;
  }
  return false;
}

/// Where the texel (0, 0) of the page that holds `texel` lies in the pool; NoTexel for a page that nobody marked.
uint page_origin(Pool pool, MapRecord map, uint view, uvec2 texel) {
  PagePlace place = page_place(map, view, texel);
  uint bits = pool.page_bits.v[place.word];
  if ((bits >> place.bit & 1u) == 0u) return NoTexel;
  return page_texel(bits, pool.page_first.v[place.word], place.bit, map.resolution);
}

/// Bits begin … end-1 of a word; end - begin <= 32.
uint bits_between(int begin, int end) { return begin < end ? (0xffffffffu >> (32 - (end - begin))) << begin : 0u; }
