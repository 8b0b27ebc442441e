// Arrays of the maps' records by address.
#include "clusters/cluster_buffers.glsl"
#include "maps/map_push.shared.h"
#include "maps/resolution.shared.h"

UMB_ARRAY(Maps, MapRecord, 4);
UMB_ARRAY(LightMapList, LightMaps, 4);
UMB_ARRAY(Requests, LightRequest, 4);
UMB_ARRAY(Views, ShadowView, 4);

/// Large indirect dispatches have two dimensions (set_groups).
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
