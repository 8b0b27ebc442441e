// A texel of a map, wherever the store keeps it; a part of umbrage.glsl.

#ifndef UMBRAGE_VISIT_TEXEL
#define UMBRAGE_VISIT_TEXEL(texel)   // a texel of the pool that a tap reads, for hosts that count them
#endif

/// First texel in the pool of a view's page, where there is one (else 0); NoIndex for a page that nobody marked.
UMB_FN uint find_page(Frame frame, Map map, uint view, uint page) {
  uint word = map.first_word + view * map.words + page / 32u;
  uint bits = UmbrageUints(frame.page_bits).v[word];
  uint bit = page % 32u;
  uint first = 0u;
  if (store_of(frame) == StorePool) first = page_texel(bits, UmbrageUints(frame.page_first).v[word], bit, map.resolution);
  return (bits >> bit & 1u) != 0u ? first : NoIndex;
}

/// Counts a tap on a texel that mark_texels did not foresee: nobody drew it.
UMB_FN void check_texel(Frame frame, Map map, uvec2 texel, uint first) {
#ifdef UMBRAGE_CHECK_TEXELS   // needs UMBRAGE_COUNT_TAPS
  UmbrageFrames f = UmbrageFrames(frame.address);
  if (f.v[0].texel_bits == 0ul || map.receivers != ReceiversInSight || map.resolution < PageSide) return;
  uint row = UmbrageUints(f.v[0].texel_bits).v[texel_word(first, texel.y % PageSide)];
  if ((row >> texel.x % PageSide & 1u) == 0u) atomicAdd(UmbrageTapCounter(f.v[0].tap_counts).taps.unbacked, 1u);
#endif
}

/// A texel of a page, 0 where there is none. first: as find_page() says.
UMB_FN float texel_of_page(Frame frame, Map map, uint view, uvec2 texel, uint first) {
  float depth = 0.0f;
  if (store_of(frame) == StorePool) {
    uint place = first == NoIndex ? 0u : first + texel_in_page(texel, map.resolution);   // no branch: the pool has a first texel
    if (first != NoIndex) {
      UMBRAGE_VISIT_TEXEL(place);
      check_texel(frame, map, texel, first);
    }
    float read = uintBitsToFloat(UmbrageUints(frame.pool).v[place]);
    depth = first == NoIndex ? 0.0f : read;
  }
#ifdef UMBRAGE_SET
  else if (first != NoIndex) {
    ivec3 at = ivec3(texel, map.layer + view);
    if (store_of(frame) == StoreSparseWords) {
      depth = uintBitsToFloat(texelFetch(umbrage_words[nonuniformEXT(map.image)], at, 0).x);
    } else {
      depth = texelFetch(umbrage_images[nonuniformEXT(map.image)], at, 0).x;
    }
  }
#endif
  return depth;
}

/// A texel of any store; missing: counts texels without a page.
UMB_FN float stored_depth(Frame frame, Map map, uint view, uvec2 texel, inout uint missing) {
  float depth = 0.0f;
#ifdef UMBRAGE_SET
  if (store_of(frame) == StoreAtlas) {
    UmbrageFrames f = UmbrageFrames(frame.address);
    uvec2 tile = atlas_tile(map.first_view + view, f.v[0].atlas_columns, f.v[0].atlas_resolution);
    depth = texelFetch(umbrage_atlas, ivec2(tile + texel), 0).x;
  } else if (store_of(frame) == StoreImages) {
    bool drawn = (map.faces >> view & 1u) != 0u;
    if (drawn) depth = texelFetch(umbrage_images[nonuniformEXT(map.image)], ivec3(texel, map.layer + view), 0).x;
    missing += drawn ? 0u : 1u;
  } else
#endif
  {
    uint first = find_page(frame, map, view, (texel.y / PageSide) * map.pages + texel.x / PageSide);
    missing += first == NoIndex ? 1u : 0u;
    depth = texel_of_page(frame, map, view, texel, first);
  }
  return depth;
}

/// 3×3 texels of a view: neighbours, but that at the view's border two may be the same.
struct Nine {
  uvec3 columns;
  uvec3 rows;
};

/// Their depths, row by row, from at most four pages.
UMB_FN void nine_of_pages(Frame frame, Map map, uint view, Nine texels, inout uint missing, out vec3 depths[3]) {
  uvec2 begin = uvec2(texels.columns.x, texels.rows.x) / PageSide;
  uvec2 end = uvec2(texels.columns.z, texels.rows.z) / PageSide;
  uint page = begin.y * map.pages + begin.x;
  uvec4 first = uvec4(find_page(frame, map, view, page));   // left and right above, then below
  if (any(notEqual(begin, end))) {
    uint right = end.x - begin.x;
    uint below = (end.y - begin.y) * map.pages;
    first.y = find_page(frame, map, view, page + right);
    first.z = find_page(frame, map, view, page + below);
    first.w = find_page(frame, map, view, page + below + right);
  }
  bool middle_is_right = texels.columns.y / PageSide == end.x;
  for (uint y = 0u; y < 3u; ++y) {
    uvec2 row = texels.rows[y] / PageSide == end.y ? first.zw : first.xy;
    uvec3 places = uvec3(row.x, middle_is_right ? row.y : row.x, row.y);
    for (uint x = 0u; x < 3u; ++x) {
      depths[y][x] = texel_of_page(frame, map, view, uvec2(texels.columns[x], texels.rows[y]), places[x]);
      missing += places[x] == NoIndex ? 1u : 0u;
    }
  }
}

UMB_FN void nine_depths(Frame frame, Map map, uint view, Nine texels, inout uint missing, out vec3 depths[3]) {
  if (store_of(frame) == StoreAtlas || store_of(frame) == StoreImages) {
    for (uint i = 0u; i < 9u; ++i) {
      depths[i / 3u][i % 3u] = stored_depth(frame, map, view, uvec2(texels.columns[i % 3u], texels.rows[i / 3u]), missing);
    }
  } else {
    nine_of_pages(frame, map, view, texels, missing, depths);
  }
}
