// A directional light as levels. The world is seen along the light on one plane for ever: x and y from world up, the world's
// origin in its middle. Level l cuts the plane's side into 2^l texels; a map of the light is a window of a level, so that moving
// a window, or the camera, moves no texel. Texels are a power of two of the world's unit wide, whatever the casters do.
#ifndef UMBRAGE_VIEWS_SUN_LEVELS_SHARED_H
#define UMBRAGE_VIEWS_SUN_LEVELS_SHARED_H
#include "views/shadow_view.shared.h"

UMB_NAMESPACE_BEGIN

/// Levels of a sun. Texels of the finest are eight steps of the floats that its casters' coordinates have; on the coarsest every
/// caster lies in the middle four.
UMB_CONST uint SunCoarsestLevel = 2u;
UMB_CONST uint SunFinestLevel = 26u;
UMB_CONST uint SunPlaces = SunFinestLevel - SunCoarsestLevel + 1u;
/// The shadow views of a directional light: all casters in one; a window at each place (finest first); the plane.
UMB_CONST uint SunFirstWindow = 1u;
UMB_CONST uint SunPlane = SunFirstWindow + SunPlaces;
UMB_CONST uint SunViews = SunPlane + 1u;
/// Windows of at least SunPagedWindow texels begin at multiples of SunWindowStep texels, which are whole pages.
UMB_CONST uint SunPagedWindow = 256u;
UMB_CONST uint SunWindowStep = 64u;

/// The least power of two that is not below a positive number.
UMB_FN float power_of_two_above(float x) { return uintBitsToFloat((floatBitsToUint(x) + 0x7fffffu) & 0x7f800000u); }

/// The plane as a view: 32 times as wide as the casters' largest coordinate in powers of two, and its depths, which reach as far
/// to both sides of the origin as casters can. Nothing else of the casters enters it.
UMB_FN ShadowView sun_plane(vec3 direction, vec3 box_min, vec3 box_max) {
  vec3 largest = max(abs(box_min), abs(box_max));
  float reach = power_of_two_above(max(max(largest.x, max(largest.y, largest.z)), 1e-6f));
  return parallel_view(vec3(0.0f), transpose(view_rotation(direction)), 16.0f * reach, 4.0f * reach, 0.5f);
}

/// A rectangle of the plane in its view's coordinates; lo > hi: empty.
struct SunRect {
  vec2 lo;
  vec2 hi;
};
UMB_ASSERT_SIZE(SunRect, 16);

/// What a world box covers of the plane.
UMB_FN SunRect sun_rect(ShadowView plane, vec3 box_min, vec3 box_max) {
  vec3 centre = (box_min + box_max) * 0.5f;
  vec3 half_size = (box_max - box_min) * 0.5f;
  vec2 at = vec2(dot(plane.x_row, centre), dot(plane.y_row, centre));
  vec2 extent = vec2(dot(abs(plane.x_row), half_size), dot(abs(plane.y_row), half_size));
  SunRect rect;
  rect.lo = at - extent;
  rect.hi = at + extent;
  return rect;
}

/// The part that has casters: beyond the view that holds all of them every point is lit.
UMB_FN SunRect sun_casters(ShadowView plane, ShadowView casters) {
  float half_side = casters.side_m / plane.side_m;
  vec2 at = vec2(dot(plane.x_row, casters.origin), dot(plane.y_row, casters.origin));
  SunRect rect;
  rect.lo = at - vec2(half_side);
  rect.hi = at + vec2(half_side);
  return rect;
}

UMB_FN SunRect sun_overlap(SunRect a, SunRect b) {
  SunRect rect;
  rect.lo = max(a.lo, b.lo);
  rect.hi = min(a.hi, b.hi);
  return rect;
}
UMB_FN bool sun_rect_is_empty(SunRect rect) { return rect.lo.x > rect.hi.x || rect.lo.y > rect.hi.y; }

/// Texels `first` … first + side-1 of a level, counted from the plane's middle.
struct SunWindow {
  ivec2 first;
  uint side;
  uint holds;   // 1: all that was asked for
};
UMB_ASSERT_SIZE(SunWindow, 16);

/// Begins of windows are multiples of so many texels.
UMB_FN uint sun_window_step(uint side) { return max(min(side / 4u, SunWindowStep), 1u); }

UMB_FN ivec2 sun_texel(vec2 at, float half_texels) {
  vec2 texel = floor(at * half_texels);
  return ivec2(int(texel.x), int(texel.y));
}
UMB_FN int round_down(int x, int unit) { return (x >= 0 ? x : x - unit + 1) / unit * unit; }

/// The smallest window with the taps of all receivers in a rectangle, or where `most` texels are too few, one around its middle.
/// most: a power of two ≥ 4.
UMB_FN SunWindow sun_window(SunRect rect, uint level, uint most) {
  uint whole = 1u << level;
  float half_texels = 0.5f * float(whole);
  if (sun_rect_is_empty(rect)) rect.lo = rect.hi = vec2(0.0f);
  // A little farther than taps, for the rounding of coordinates far from the origin.
  vec2 far = max(abs(rect.lo), abs(rect.hi)) * half_texels;
  float reach = FilterTexels + max(far.x, far.y) * 1e-6f;
  ivec2 first = sun_texel(rect.lo - vec2(reach / half_texels), half_texels);
  ivec2 last = sun_texel(rect.hi + vec2(reach / half_texels), half_texels);
  SunWindow window;
  window.holds = 1u;
  window.side = min(SunPagedWindow, min(whole, most));
  while (true) {
    int step = int(sun_window_step(window.side));
    window.first = ivec2(round_down(first.x, step), round_down(first.y, step));
    if (max(last.x - window.first.x, last.y - window.first.y) < int(window.side)) return window;
    if (window.side == min(whole, most)) break;
    window.side *= 2u;
  }
  int half_side = int(window.side / 2u);
  int step = int(sun_window_step(window.side));
  if (window.side == whole) {
    window.first = ivec2(-half_side);   // all there is
    return window;
  }
  window.holds = 0u;
  window.first = ivec2(round_down((first.x + last.x) / 2 - half_side, step), round_down((first.y + last.y) / 2 - half_side, step));
  return window;
}

/// The view of a window. Its rows are the plane's times a power of two, and what is added is a whole number of texels: positions
/// that are rounded to the sub-texels of a level lie on the same ones in each of its windows.
UMB_FN ShadowView sun_window_view(ShadowView plane, SunWindow window, uint level) {
  float scale = float(1u << level) / float(window.side);
  ShadowView view = plane;
  view.x_row = plane.x_row * scale;
  view.y_row = plane.y_row * scale;
  view.side_m = plane.side_m / scale;
  view.x_offset = float(-2 * window.first.x - int(window.side)) / float(window.side);
  view.y_offset = float(-2 * window.first.y - int(window.side)) / float(window.side);
  view.grid = ViewSubTexels * 0.5f * float(window.side);
  view.resolution = window.side;
  return view;
}

/// Do the taps of all receivers in a rectangle lie in a window? rect: of what has casters.
UMB_FN bool sun_window_holds(ShadowView plane, ShadowView window, SunRect rect) {
  if (sun_rect_is_empty(rect)) return true;
  float scale = plane.side_m / window.side_m;
  float reach = 2.0f * FilterTexels / float(window.resolution);
  vec2 offset = vec2(window.x_offset, window.y_offset);
  vec2 lo = rect.lo * scale + offset - reach;
  vec2 hi = rect.hi * scale + offset + reach;
  return lo.x >= -1.0f && lo.y >= -1.0f && hi.x <= 1.0f && hi.y <= 1.0f;
}

// --- Which levels -------------------------------------------------------------------------------------------------------

/// The coarsest level with texels no larger than those of a plane of so many. (Not the nearest, as for other lights: where the sun
/// is high every ledge casts a shadow of a pixel or two, and half of them would be lost.)
UMB_FN uint sun_place_of_request(float resolution) {
  float level = ceil(log2(max(resolution, 1.0f)));
  return SunFinestLevel - max(floor_to_uint(level, SunFinestLevel), SunCoarsestLevel);
}

/// Moves places towards coarser ones; the last is the coarsest.
UMB_FN uint sun_shifted_places(uint places, uint shift) {
  uint by = min(shift, SunPlaces - 1u);
  uint moved = (places << by) & ((1u << SunPlaces) - 1u);
  return (places >> (SunPlaces - 1u - by)) != 0u ? moved | (1u << (SunPlaces - 1u)) : moved;
}

/// Of too many places every second, third … , the coarsest always.
UMB_FN uint sun_kept_places(uint places, uint most) {
  uint every = (uint(bitCount(places)) + most - 1u) / max(most, 1u);
  uint kept = 0u;
  uint rank = 0u;
  for (uint left = places; left != 0u; ++rank) {
    uint coarsest = 1u << uint(findMSB(left));
    if (rank % every == 0u) kept |= coarsest;
    left &= ~coarsest;
  }
  return kept;
}

/// Number of the map, finest first, that answers at a place: the place's own, else the next coarser one.
UMB_FN uint sun_map_of_place(uint kept, uint place) { return uint(bitCount(kept & ((1u << place) - 1u))); }

UMB_NAMESPACE_END
#endif
