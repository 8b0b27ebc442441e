// Limits in one place, with what each costs.
#ifndef UMBRAGE_CORE_LIMITS_SHARED_H
#define UMBRAGE_CORE_LIMITS_SHARED_H
#include "core/shared_math.h"

UMB_NAMESPACE_BEGIN

/// O1: pixels along a cluster tile's side. Smaller tiles cull better and make more clusters.
UMB_CONST uint TileSide = 32u;
/// Depth slices at most: 1080p at 60 degrees reaches 27 million times the near plane. 16 words a tile in the cluster table.
UMB_CONST uint MaxSlices = 512u;
UMB_CONST uint SliceWords = 16u;
/// Room for occupied clusters, per tile on average; beyond it a cluster takes all lights (slow, never wrong).
UMB_CONST uint ClustersPerTile = 24u;
/// Children of a tree node (O5).
UMB_CONST uint TreeWidth = 32u;
UMB_CONST uint MaxTreeLevels = 6u;
/// Texels of filter radius that a spot's and a directional light's view keep around what they light.
UMB_CONST uint ViewGuardTexels = 3u;
/// Alpha masks of one system.
UMB_CONST uint MaxMasks = 1024u;

UMB_CONST uint NoIndex = 0xffffffffu;

UMB_NAMESPACE_END
#endif
