// What a frame counts on the device, and what of it goes back to the host.
#ifndef UMBRAGE_CLUSTERS_FRAME_REPORT_SHARED_H
#define UMBRAGE_CLUSTERS_FRAME_REPORT_SHARED_H
#include "core/shared_math.h"

UMB_NAMESPACE_BEGIN

/// What the frame counts; set to 0 (pair_limit by the host) when it begins. The first words are arguments of indirect dispatches.
struct FrameCounters {
  uint cluster_groups[3];    // of 64 clusters
  uint clusters;             // within capacity
  uint clusters_found;
  uint pairs_found;
  uint lights_visible;
  uint caster_pairs;
  uint views_drawn;
  uint pair_limit;           // caster pairs that the recorded rounds can draw
  uint batches_drawn_low, batches_drawn_high;
  uint triangles_drawn_low, triangles_drawn_high;
  uint all_lights_used;
  // Virtual shadow maps. Groups of indirect dispatches first; those of `fit_` are 0 once the pages fit the pool.
  uint pair_groups[3];       // of 64 cluster/light pairs
  uint map_groups[3];        // a workgroup a map
  uint fit_pair_groups[3];
  uint fit_map_groups[3];
  uint fit_word_groups[3];   // of 64 page words
  uint clear_groups[3];      // a workgroup per ClearUnits of the pool
  uint maps, maps_found;     // within capacity; that there would be
  uint page_words, page_words_found;
  uint receiver_views, receiver_views_found;
  uint pages_requested;      // at the resolutions asked for
  uint pages;                // that have memory
  uint pool_units;           // that the pages of this round need
  uint pool_units_asked;     // that those of the first round would
  uint fitted;               // 1: they fit
  uint lights_shifted;       // lights that are coarser than they asked
  uint large_triangles;      // of the round with most that the page rasteriser would queue
  uint pages_listed;         // hardware sparse: for the host to bind
};
UMB_ASSERT_SIZE(FrameCounters, 188);

/// What lookups count, where the host asks for it (UMBRAGE_COUNT_TAPS).
struct TapCounts {
  uint unbacked;             // texels that nothing backs
  uint unmarked;             // that were not marked: answered by the light's whole map
};
UMB_ASSERT_SIZE(TapCounts, 8);

/// What goes back to the host, in this order; words of the used lights follow.
struct FrameReport {
  TapCounts taps;            // written by lookups
  FrameCounters counters;
};
UMB_ASSERT_SIZE(FrameReport, 196);

/// Words of the used lights: bits.
UMB_CONST uint LightIsUsed = 1u;
UMB_CONST uint LightLacksCasters = 2u;
UMB_CONST uint LightReachesBoxes = 4u;  // of points that no depth buffer holds
UMB_CONST uint LightShiftAt = 8u;       // halvings of its resolutions, from this bit on

UMB_NAMESPACE_END
#endif
