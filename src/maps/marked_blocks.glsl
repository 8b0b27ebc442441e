// Blocks of texels that a store backs at once, and whether anything in one is marked. Needs map_buffers.glsl.

/// Blocks along the sides of a view with this resolution.
uvec2 blocks_of(uint resolution) { return (uvec2(resolution) + backing() - 1u) / backing(); }

/// Pool units of a block; of maps below a page, which are one block, only their own texels, or none.
uint block_units(uint resolution) {
  if (resolution < least_backed(backing().x)) return has_flag(MapsSparse) ? 0u : page_units_of(resolution);
  return backing().x * backing().y / PoolUnit;
}

bool is_marked(FrameRecord frame, MapRecord map, uint view, uint x, uint y) {
  uint page = y * map.pages + x;
  return (Uints(frame.page_bits).v[map.first_word + view * map.words + page / 32u] & (1u << (page % 32u))) != 0u;
}

/// Is a page marked in this block of the view, had it the other resolution?
bool any_marked(FrameRecord frame, MapRecord map, uint view, uvec2 block, uint resolution) {
  uvec2 first = block * backing();
  uvec2 last = min(first + backing(), uvec2(resolution));
  uvec2 begin = first * map.pages / resolution;
  uvec2 end = (last * map.pages + (resolution - 1u)) / resolution;
  for (uint row = begin.y; row < end.y; ++row)
    for (uint column = begin.x; column < end.x; ++column)
      if (is_marked(frame, map, view, column, row)) return true;
  return false;
}
