// The grid on which a light's cascades lie, the same in C++ and GLSL: texels and depth units counted from the world's origin, so
// that a caster has the same coordinates wherever the camera is, and a map that moves by whole steps keeps its texels (C7, E16).
#ifndef UMBRAGE_CASCADES_GRID_SHARED_H
#define UMBRAGE_CASCADES_GRID_SHARED_H
#include "core/rounding.shared.h"
#include "scene/scene_types.shared.h"

UMB_NAMESPACE_BEGIN

/// Linear 16-bit depth (C1): 0 at the near side, FarDepth the last one that a caster can have, ClearDepth = 1.0 where none is.
/// A unit is 1/65535 of the range, not 2^-16 as the paper has it: with that, moves by whole units are exact (E16).
UMB_CONST uint ClearDepth = 65535u;
UMB_CONST int FarDepth = 65534;
/// Grid coordinates are exact integers within these; what lies beyond is cut off (texels) or moved there (depth).
UMB_CONST float MostTexels = 2097152.0f;
UMB_CONST float MostUnits = 4194304.0f;

/// CascadeRecord::flags.
UMB_CONST uint CascadeHolds = 1u;       // the static map of the frame before may be used again, as far as the host knows
UMB_CONST uint CascadeLiteral = 2u;     // sets as printed: casters across the old border are not drawn again (E17, E18)
UMB_CONST uint CascadeAllStatic = 4u;   // everything goes to the static map, which is drawn anew each frame

/// One cascade of one light in one frame. Grid position of a world position p: (dot(x_row, p), dot(y_row, p), dot(z_row, p)).
struct CascadeRecord {
  vec3 x_row;
  float texel_m;
  vec3 y_row;
  float unit_m;            // of depth
  vec3 z_row;
  uint light;              // slot
  ivec3 origin;            // where the volume V begins
  uint side;               // texels; the volume's depth is FarDepth + 1 units
  ivec3 former;            // origin in the frame before: V'
  uint flags;
  uint first_texel;        // of its map
  uint light_mask;
  float begin_m, end_m;    // view depths of its sub-frustum
};
UMB_ASSERT_SIZE(CascadeRecord, 96);

/// Grid cells that a world box may touch; both ends belong to it.
struct GridBox {
  ivec3 lo;
  ivec3 hi;
};
UMB_ASSERT_SIZE(GridBox, 24);

/// Texels of a map; none where first > last.
struct TexelRect {
  ivec2 first;
  ivec2 last;
};
UMB_ASSERT_SIZE(TexelRect, 16);

UMB_FN vec3 grid_position(CascadeRecord cascade, vec3 position_ws) {
  UMB_PRECISE float x = dot(cascade.x_row, position_ws);
  UMB_PRECISE float y = dot(cascade.y_row, position_ws);
  UMB_PRECISE float z = dot(cascade.z_row, position_ws);
  return vec3(x, y, z);
}

UMB_FN int grid_floor(float value, float most) { return round_to_int(floor(clamp(value, -most, most))); }

/// A cell larger on every side than the box: vertices are rounded otherwise than boxes.
UMB_FN GridBox grid_box(CascadeRecord cascade, Box box) {
  vec3 centre = grid_position(cascade, (box.lo + box.hi) * 0.5f);
  vec3 half_size = (box.hi - box.lo) * 0.5f;
  vec3 extent = vec3(dot(abs(cascade.x_row), half_size), dot(abs(cascade.y_row), half_size), dot(abs(cascade.z_row), half_size));
  vec3 slack = vec3(1.0f) + (abs(centre) + extent) * 2e-6f;
  vec3 lo = centre - extent - slack;
  vec3 hi = centre + extent + slack;
  GridBox grid;
  grid.lo = ivec3(grid_floor(lo.x, MostTexels), grid_floor(lo.y, MostTexels), grid_floor(lo.z, MostUnits));
  grid.hi = ivec3(grid_floor(hi.x, MostTexels), grid_floor(hi.y, MostTexels), grid_floor(hi.z, MostUnits));
  return grid;
}

// --- Sets (C2, C3) ----------------------------------------------------------------------------------------------------

/// Parts of a map that casters are drawn into, with a scissor of its own each.
UMB_CONST uint RegionWhole = 1u;
UMB_CONST uint RegionColumns = 2u;      // columns that the move exposed
UMB_CONST uint RegionRows = 4u;         // rows that it exposed, without those columns
UMB_CONST uint RegionKept = 8u;         // what was scrolled
UMB_CONST uint RegionKinds = 4u;

/// What becomes of a static map (CascadeState::action).
UMB_CONST uint MapIsKept = 0u;
UMB_CONST uint MapIsScrolled = 1u;
UMB_CONST uint MapIsCleared = 2u;

UMB_FN TexelRect region_rect(CascadeRecord cascade, uint region) {
  int last = int(cascade.side) - 1;
  ivec2 by = ivec2(cascade.origin.x - cascade.former.x, cascade.origin.y - cascade.former.y);
  TexelRect rect;
  rect.first = ivec2(0);
  rect.last = ivec2(last);
  if (region == RegionWhole) return rect;
  ivec2 kept_first = max(ivec2(0) - by, ivec2(0));
  ivec2 kept_last = min(ivec2(last) - by, ivec2(last));
  if (region == RegionColumns) {
    rect.first.x = by.x > 0 ? max(kept_last.x + 1, 0) : 0;
    rect.last.x = by.x > 0 ? last : min(kept_first.x - 1, last);
    return rect;
  }
  rect.first.x = kept_first.x;
  rect.last.x = kept_last.x;
  if (region == RegionKept) {
    rect.first.y = kept_first.y;
    rect.last.y = kept_last.y;
    return rect;
  }
  rect.first.y = by.y > 0 ? max(kept_last.y + 1, 0) : 0;
  rect.last.y = by.y > 0 ? last : min(kept_first.y - 1, last);
  return rect;
}

UMB_FN bool rect_is_empty(TexelRect rect) { return rect.first.x > rect.last.x || rect.first.y > rect.last.y; }

/// A box over texels of the map at `origin`.
UMB_FN bool box_meets_rect(GridBox box, ivec3 origin, TexelRect rect) {
  return !rect_is_empty(rect) && box.hi.x - origin.x >= rect.first.x && box.lo.x - origin.x <= rect.last.x &&
         box.hi.y - origin.y >= rect.first.y && box.lo.y - origin.y <= rect.last.y;
}

/// In the volume at `origin`, or between it and the light: what lies before its near side is drawn at depth 0.
UMB_FN bool box_meets_volume(GridBox box, ivec3 origin, uint side) {
  TexelRect rect;
  rect.first = ivec2(0);
  rect.last = ivec2(int(side) - 1);
  return box_meets_rect(box, origin, rect) && box.lo.z <= origin.z + FarDepth;
}

/// Does what lies between two depths come up in the kept part of a map that was scrolled? It stood before the near side of V' and
/// was clamped there, or beyond its far side.
UMB_FN bool appears_in_depth(CascadeRecord cascade, int nearest, int farthest) {
  int deeper = cascade.origin.z - cascade.former.z;
  return (deeper < 0 && nearest < cascade.former.z) || (deeper > 0 && farthest > cascade.former.z + FarDepth);
}

/// Where a static caster is drawn into the static map: the set ΔS, or S if the map was cleared. was_static: in the frame before.
/// Corrected (E17, E18), these are parts of V \ V' in three dimensions: with what the move exposed at the sides, what stood before
/// the near side of V' or beyond its far side, of which the scrolled depths know nothing.
UMB_FN uint static_regions(CascadeRecord cascade, uint action, GridBox box, bool was_static) {
  if (!box_meets_volume(box, cascade.origin, cascade.side)) return 0u;
  if (action == MapIsCleared || !was_static) return RegionWhole;
  if ((cascade.flags & CascadeLiteral) != 0u) return box_meets_volume(box, cascade.former, cascade.side) ? 0u : RegionWhole;
  if (action == MapIsKept) return 0u;
  uint regions = 0u;
  if (box_meets_rect(box, cascade.origin, region_rect(cascade, RegionColumns))) regions |= RegionColumns;
  if (box_meets_rect(box, cascade.origin, region_rect(cascade, RegionRows))) regions |= RegionRows;
  if (appears_in_depth(cascade, box.lo.z, box.hi.z) && box_meets_rect(box, cascade.origin, region_rect(cascade, RegionKept)))
    regions |= RegionKept;
  return regions;
}

/// Does the static map become wrong when a caster that it holds moves or goes? Yes if that stood in V and in V' (∩S of C3).
UMB_FN bool move_breaks_map(CascadeRecord cascade, GridBox former_box) {
  return box_meets_rect(former_box, cascade.origin, region_rect(cascade, RegionKept)) &&
         former_box.lo.z <= min(cascade.origin.z, cascade.former.z) + FarDepth;
}

/// What becomes of the static map. is_broken: a caster in it has moved.
UMB_FN uint action_of(CascadeRecord cascade, bool is_broken) {
  if ((cascade.flags & CascadeHolds) == 0u || is_broken) return MapIsCleared;
  return all(equal(cascade.origin, cascade.former)) ? MapIsKept : MapIsScrolled;
}

/// A depth of the frame before, `deeper` units of which have gone (C6): a clear texel stays clear, what comes before the near
/// side stays there.
UMB_FN uint scrolled_depth(uint depth, int deeper) {
  if (depth == ClearDepth) return ClearDepth;
  int moved = int(depth) - deeper;
  return moved > FarDepth ? ClearDepth : uint(max(moved, 0));
}

// --- Static and active (C1) -------------------------------------------------------------------------------------------

/// Of a caster's time: it cannot move, so it is static from then on.
UMB_CONST uint NeverMoves = 0x80000000u;
/// Static at `time` after having stood still for `static_after` ticks. Times of frames differ and stay below NeverMoves.
UMB_FN bool is_static_at(uint moved_at, uint time, uint static_after) {
  uint since = moved_at & ~NeverMoves;
  return since <= time && ((moved_at & NeverMoves) != 0u || time - since >= static_after);
}

UMB_NAMESPACE_END
#endif
