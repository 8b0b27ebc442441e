// The push constant of most passes of maps, and what they find by it.
#include "maps/map_arrays.glsl"
#include "views/sun_levels.shared.h"
layout(push_constant, scalar) uniform PushBlock { MapsPush push; };

uint global_index(uint threads) { return group_index() * threads + gl_LocalInvocationIndex; }

bool has_flag(uint flag) { return (push.flags & flag) != 0u; }
/// Are the light's maps windows of levels?
bool has_levels(LightRecord light) { return has_flag(MapsSunLevels) && light.views == ViewsOrtho; }
/// Texels along the sides of what the store backs at once.
uvec2 backing() { return uvec2(push.backing & 0xffffu, push.backing >> 16u); }
/// The number of a record's cluster/light pairs that have a place.
uint pair_count() { return min(Counters(push.counters).counters.pairs_found, Frame(push.frame).record.pair_capacity); }
