// What the writers of the page pool read and write, by address, and where a block of texels lies in the pool.
#include "scene/scene_buffers.glsl"
#include "raster/raster_types.shared.h"

UMB_ARRAY(Maps, MapRecord, 4);
UMB_ARRAY(Views, ShadowView, 4);
UMB_ARRAY(Items, CasterItem, 4);
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Frame { FrameRecord v; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ItemCounts { DrawCounts v; };

const uint NoTexel = 0xffffffffu;

/// Where the texel (0, 0) of the page that holds `texel` lies in the pool; NoTexel for a page that nobody marked.
uint page_origin(Frame frame, MapRecord map, uint view, uvec2 texel) {
  PagePlace place = page_place(map, view, texel);
  uint bits = Uints(frame.v.page_bits).v[place.word];
  if ((bits >> place.bit & 1u) == 0u) return NoTexel;
  return page_texel(bits, Uints(frame.v.page_first).v[place.word], place.bit, map.resolution);
}

