// Arrays of the maps' records by address, and the push constant of their passes.
#include "clusters/cluster_buffers.glsl"
#include "maps/map_push.shared.h"
#include "maps/resolution.shared.h"
#include "views/sun_levels.shared.h"

UMB_ARRAY(Maps, MapRecord, 4);
UMB_ARRAY(LightMapList, LightMaps, 4);
UMB_ARRAY(Requests, LightRequest, 4);
UMB_ARRAY(Views, ShadowView, 4);
layout(push_constant, scalar) uniform PushBlock { MapsPush push; };

/// Large indirect dispatches have two dimensions (set_groups).
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint global_index(uint threads) { return group_index() * threads + gl_LocalInvocationIndex; }

bool has_flag(uint flag) { return (push.flags & flag) != 0u; }
/// Are the light's maps windows of levels?
bool has_levels(LightRecord light) { return has_flag(MapsSunLevels) && light.views == ViewsOrtho; }
/// Texels along the sides of what the store backs at once.
uvec2 backing() { return uvec2(push.backing & 0xffffu, push.backing >> 16u); }
/// The number of a record's cluster/light pairs that have a place.
uint pair_count() { return min(Counters(push.counters).counters.pairs_found, Frame(push.frame).record.pair_capacity); }
