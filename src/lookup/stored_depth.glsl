// A texel of a map, wherever the store keeps it; a part of umbrage.glsl.

#ifndef UMBRAGE_VISIT_TEXEL
#define UMBRAGE_VISIT_TEXEL(texel)   // a texel of the pool that a tap reads, for hosts that count them
#endif

/// Where the last tap was found: neighbours mostly share its page.
struct TapPage {
  uint key;          // view and page
  uint first;        // as find_page() says
  uint missing;      // taps without a page
};

/// First texel in the pool of a view's page, where there is one (else 0); NoIndex for a page that nobody marked.
UMB_FN uint find_page(Frame frame, Map map, uint view, uint page) {
  UmbrageFrames f = UmbrageFrames(frame.address);
  uint word = map.first_word + view * map.words + page / 32u;
  uint bits = UmbrageUints(f.v[0].page_bits).v[word];
  uint bit = page % 32u;
  if ((bits & (1u << bit)) == 0u) return NoIndex;
  if (store_of(frame) != StorePool) return 0u;
  return page_texel(bits, UmbrageUints(f.v[0].page_first).v[word], bit, map.resolution);
}

/// A texel of a page that is there. first: as find_page() says.
UMB_FN float texel_of_page(Frame frame, Map map, uint view, uvec2 texel, uint first) {
#ifdef UMBRAGE_SET
  ivec3 at = ivec3(texel, map.layer + view);
  if (store_of(frame) == StoreSparseWords) return uintBitsToFloat(texelFetch(umbrage_words[nonuniformEXT(map.image)], at, 0).x);
  if (store_of(frame) == StoreSparseDepth) return texelFetch(umbrage_images[nonuniformEXT(map.image)], at, 0).x;
#endif
  uint place = first + texel_in_page(texel, map.resolution);
  UMBRAGE_VISIT_TEXEL(place);
  return uintBitsToFloat(UmbrageUints(UmbrageFrames(frame.address).v[0].pool).v[place]);
}

UMB_FN float stored_depth(Frame frame, Map map, uint view, uvec2 texel, inout TapPage last) {
#ifdef UMBRAGE_SET
  if (store_of(frame) == StoreAtlas) {
    uvec2 tile = atlas_tile(map.first_view + view, UmbrageFrames(frame.address).v[0].atlas_columns, UmbrageFrames(frame.address).v[0].atlas_resolution);
    return texelFetch(umbrage_atlas, ivec2(tile + texel), 0).x;
  }
  if (store_of(frame) == StoreImages) {
    if ((map.faces >> view & 1u) != 0u) return texelFetch(umbrage_images[nonuniformEXT(map.image)], ivec3(texel, map.layer + view), 0).x;
    ++last.missing;
    return 0.0f;
  }
#endif
  uint page = (texel.y / PageSide) * map.pages + texel.x / PageSide;
  uint key = view << 16u | page;
  if (key != last.key) {
    last.key = key;
    last.first = find_page(frame, map, view, page);
  }
  if (last.first == NoIndex) {
    ++last.missing;
    return 0.0f;
  }
  return texel_of_page(frame, map, view, texel, last.first);
}

/// The pages of 3×3 texels: one, or two side by side, or four.
struct TapPages {
  uvec4 first;       // in the pool; left and right above, then below; NoIndex: not there
  uvec2 split;       // texels from here on lie in the right or the lower pages
};

UMB_FN TapPages pages_around(Frame frame, Map map, uint view, uvec2 middle) {
  uvec2 begin = (middle - 1u) / PageSide;
  uvec2 end = (middle + 1u) / PageSide;
  uint page = begin.y * map.pages + begin.x;
  TapPages around;
  around.first = uvec4(find_page(frame, map, view, page));
  around.split = end * PageSide;
  if (begin.x != end.x) around.first.yw = uvec2(find_page(frame, map, view, page + 1u));
  if (begin.y != end.y) {
    around.first.zw = uvec2(find_page(frame, map, view, page + map.pages));
    if (begin.x != end.x) around.first.w = find_page(frame, map, view, page + map.pages + 1u);
  }
  return around;
}
