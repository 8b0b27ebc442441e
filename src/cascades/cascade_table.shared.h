// The cascades of a frame as shaders find them, from one address.
#ifndef UMBRAGE_CASCADES_TABLE_SHARED_H
#define UMBRAGE_CASCADES_TABLE_SHARED_H
#include "cascades/cascade_grid.shared.h"

UMB_NAMESPACE_BEGIN

/// Cascades of all lights.
UMB_CONST uint MaxCascades = 64u;
/// Times of frames, growing from frame to frame. The planner begins anew half way to NeverMoves, after 12 days.
UMB_CONST uint TicksPerSecond = 1000u;

/// What the device knows of a cascade from frame to frame, and what it counted in this one.
struct CascadeState {
  uint is_broken;          // a caster in the static map has moved
  uint front;              // which of the two static maps is C
  uint action;             // MapIsKept, …
  uint statics, actives;   // casters listed
  uint static_triangles, active_triangles;   // of those drawn: not occluded
  uint occluded;           // casters listed and not drawn
  uint texels_exposed;     // of the static map
  uint shows_work;         // 1: the finished map is W; 0: it is C, because nothing active is in the volume
};
UMB_ASSERT_SIZE(CascadeState, 40);

/// The cascades of a frame at one address; records follow, `count` of each light one after another.
struct CascadeTable {
  uint64_t states;         // CascadeState
  uint64_t maps;           // words of depth: C and its former, then W; `texels` each
  uint64_t moved_at;       // ticks, of each caster; NeverMoves
  uint64_t known_boxes;    // world boxes of the casters as they stood when they last moved: the cached positions of S'
  uint64_t farthest;       // of each cell of each map, for occlusion
  uint texels;             // of all maps
  uint cascades;           // of all lights
  uint count;              // of a light
  uint now, before;        // ticks, of this frame and the one before
  uint static_after;       // ticks
  float blend;             // part of a cascade's depth in which it fades into the next
  uint padding;
  CascadeRecord records[MaxCascades];
};
UMB_ASSERT_SIZE(CascadeTable, 72 + 64 * 96);

UMB_NAMESPACE_END
#endif
