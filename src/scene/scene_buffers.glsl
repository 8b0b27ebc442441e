// Arrays of the scene's records by address.
#include "gpu/buffers.glsl"
#include "scene/scene_types.shared.h"

UMB_ARRAY(Lights, LightRecord, 8);
UMB_ARRAY(Instances, InstanceRecord, 8);
UMB_ARRAY(Batches, BatchRecord, 4);
UMB_ARRAY(Casters, CasterRecord, 4);
UMB_ARRAY(Boxes, Box, 4);
