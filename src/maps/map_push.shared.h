// Push constants of the passes that make views and maps.
#ifndef UMBRAGE_MAPS_PUSH_SHARED_H
#define UMBRAGE_MAPS_PUSH_SHARED_H
#include "maps/map_types.shared.h"

UMB_NAMESPACE_BEGIN

struct BuildViewsPush {    // build_views
  uint64_t frame;
  uint64_t lights;
  uint64_t used;           // words per light slot
  uint64_t counters;
  uint64_t views;
  uint64_t scene_bounds;   // ordered_bits
  uint light_slots;
  uint all_lights;         // draw maps whatever the clusters say
};
UMB_ASSERT_SIZE(BuildViewsPush, 56);

/// Per light slot: what its clusters ask for. Resolutions are positive floats, whose bits are in their order.
struct LightRequest {
  uint finest;             // bits of the largest R
  uint places;             // bit p: place p (a level, or a bucket) is asked for
  uint buckets[16];        // exact layout: bits of the largest R in each bucket
};
UMB_ASSERT_SIZE(LightRequest, 72);

/// Per light slot: pool units that its pages would need after 0, 1, … halvings.
UMB_CONST uint MaxShift = 12u;

UMB_CONST uint MapsExact = 1u;          // layout: exact, else levels
UMB_CONST uint MapsPaperResolution = 2u;
UMB_CONST uint MapsLinearBuckets = 4u;
UMB_CONST uint MapsDropFacingAway = 8u;
UMB_CONST uint MapsAllLights = 16u;     // every light gets a map of whole views
UMB_CONST uint MapsWholeImages = 32u;   // the store backs whole images: place_maps has counted them
UMB_CONST uint MapsSparse = 64u;        // the store backs blocks of `backing` texels, and maps below a page beforehand
UMB_CONST uint MapsSunLevels = 128u;    // maps of directional lights are windows of levels (views/sun_levels.shared.h)
UMB_CONST uint MapsMarkBlocks = 256u;   // mark_blocks does what mark_pages would

/// Resolution of the maps that answer for points no depth buffer saw.
UMB_CONST uint WholeResolution = 128u;
/// Units that a workgroup of clear_pages clears.
UMB_CONST uint ClearUnits = 1024u;

struct MapsPush {
  uint64_t frame;
  uint64_t counters;
  uint64_t requests;       // LightRequest per light slot
  uint64_t pair_requests;  // bits of R per pair, 0: faces away
  uint64_t pair_clusters;
  uint64_t used;           // words per light slot
  uint64_t demand;         // units [light slot][MaxShift + 1]
  uint64_t priority;       // slots, the most important first
  uint64_t views;
  uint64_t level_bounds;   // per view of a sun's window: what receivers ask for of its level, ordered_bits of -lo and hi; 0: nothing
  uint flags;
  uint maps_per_light;
  uint round;
  uint light_slots;
  uint capacity_units;
  uint word_capacity;
  uint receiver_capacity;
  uint light_count;        // in `priority`
  float undersampling;     // divides R
  uint min_resolution;
  uint max_resolution;
  uint backing;            // texels that are backed at once: width | height << 16
};
UMB_ASSERT_SIZE(MapsPush, 128);

struct PlaceLevelsPush {   // place_levels
  uint64_t frame;
  uint64_t requests;
  uint64_t level_bounds;
  uint max_resolution;     // of a window
  uint levels_per_sun;
};
UMB_ASSERT_SIZE(PlaceLevelsPush, 32);

/// Threads along the side of a workgroup of mark_texels, which has 2×2 pixels each.
UMB_CONST uint MarkSide = 8u;

struct MarkSamplesPush {   // mark_blocks, mark_texels
  uint64_t frame;
  uint64_t camera;         // CameraRecord of the one whose images are bound
  uint64_t counters;
  uint normal_encoding;
  uint drop_facing_away;
};
UMB_ASSERT_SIZE(MarkSamplesPush, 32);

/// Boxes that a thread of reach_boxes tests.
UMB_CONST uint BoxesAtOnce = 32u;

struct ReachBoxesPush {    // reach_boxes
  uint64_t lights;
  uint64_t boxes;
  uint64_t used;           // words per light slot
  uint light_slots;
  uint box_count;
};
UMB_ASSERT_SIZE(ReachBoxesPush, 32);

struct MarkBoxesPush {     // mark_boxes
  uint64_t frame;
  uint64_t counters;
  uint64_t boxes;
  uint box_count;
  uint pad;
};
UMB_ASSERT_SIZE(MarkBoxesPush, 32);

struct PlaceMapsPush {     // place_maps
  uint64_t frame;
  uint64_t counters;
  uint64_t priority;       // slots, the most important first
  uint64_t images;         // MapImage, finest first
  uint image_count;
  uint light_count;        // in `priority`
  uint whole_images;       // 1: a map is as fine as its image; 0: no finer
  uint pad;
};
UMB_ASSERT_SIZE(PlaceMapsPush, 48);

UMB_NAMESPACE_END
#endif
