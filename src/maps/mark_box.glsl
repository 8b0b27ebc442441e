// O3, O7: what receivers in a box may look up: pages of a map, tiles of its projection maps, the farthest depth in each cell of
// its depth grids. The box is grown by the filter and the bias first (E7). Includer: the arrays of map_buffers.glsl.

void set_bits(uint64_t words, uint word, uint bits) {
  if (bits != 0u && (Uints(words).v[word] & bits) != bits) atomicOr(Uints(words).v[word], bits);
}

void mark_rows(FrameRecord frame, MapRecord map, uint view, ViewFootprint seen) {
  if (map.pages == 0u) return;   // the store backs whole maps
  TileRect pages = tile_rect(seen.rect, map.pages);
  for (uint y = pages.begin.y; y < pages.end.y; ++y) {
    uvec2 span = footprint_row(seen, y, map.pages);
    if (span.x >= span.y) continue;
    uint first = y * map.pages + span.x;
    uint last = y * map.pages + span.y;
    for (uint word = first / 32u; word * 32u < last; ++word) {
      uint begin = max(first, word * 32u) - word * 32u;
      uint end = min(last, word * 32u + 32u) - word * 32u;
      set_bits(frame.page_bits, map.first_word + view * map.words + word, tile_span_mask(begin, end).x);
    }
  }
}

void mark_depths(FrameRecord frame, uint row, uvec2 span, uint bits) {
  for (uint x = span.x; x < span.y; ++x)
    if (Uints(frame.receiver_depth).v[row + x] < bits) atomicMax(Uints(frame.receiver_depth).v[row + x], bits);
}

void mark_receivers(FrameRecord frame, MapRecord map, uint view, ViewFootprint seen, float depth) {
  uint receiver = map.first_receiver + view;
  uint side = frame.receiver_grid;
  uint bits = floatBitsToUint(max(depth, 1e-30));
  TileRect tiles = tile_rect(seen.rect, ProjectionSide);
  for (uint y = tiles.begin.y; y < tiles.end.y; ++y) {
    uvec2 span = footprint_row(seen, y, ProjectionSide);
    set_bits(frame.projection, receiver * ProjectionSide + y, tile_span_mask(span.x, span.y).x);
    if (side == ProjectionSide) mark_depths(frame, (receiver * side + y) * side, span, bits);
  }
  if (side == ProjectionSide) return;
  TileRect cells = tile_rect(seen.rect, side);
  for (uint y = cells.begin.y; y < cells.end.y; ++y) mark_depths(frame, (receiver * side + y) * side, footprint_row(seen, y, side), bits);
}

/// What receivers in a box look up in a map.
void mark_box(FrameRecord frame, uint map_index, MapRecord map, Box box) {
  ShadowView view = Views(frame.views).v[map.first_view];   // the faces of a cube differ in nothing that is read here
  float margin = view_receiver_margin_m(view, map.kind, box.lo, box.hi, map.resolution);
  box.lo -= margin;
  box.hi += margin;
  uint faces = map.kind == ViewsCube ? face_mask(box.lo - view.origin, box.hi - view.origin) : 1u;
  for (; faces != 0u; faces &= faces - 1u) {
    uint face = uint(findLSB(faces));
    ViewFootprint seen;
    if (!project_box_to_view(view, map.kind, face, box.lo, box.hi, seen)) continue;
    uint bit = 1u << face;
    if ((Maps(frame.maps).v[map_index].faces & bit) == 0u) atomicOr(Maps(frame.maps).v[map_index].faces, bit);
    mark_rows(frame, map, face, seen);
    mark_receivers(frame, map, face, seen, farthest_tap_depth(view, map.kind, seen.box.hi.z, map.resolution));
  }
}
