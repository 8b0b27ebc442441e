// What the walks of fixed cubes share: a light's casters and the views that each goes to.
#include "clusters/cluster_buffers.glsl"
#include "culling/culling_types.shared.h"
#include "views/cube_projection.shared.h"

UMB_ARRAY(Views, ShadowView, 4);
UMB_ARRAY(Drawn, CasterInstance, 8);
UMB_ARRAY(Commands, DrawCommand, 4);
UMB_ARRAY(DrawCountList, DrawCounts, 4);
layout(push_constant, scalar) uniform PushBlock { TraversePush push; };

#include "culling/walk.glsl"

/// true: of a light's views only those that the batch's box meets (CFM); false: all.
layout(constant_id = 0) const bool masks_views = false;

LightRecord light;

/// Views of the light; of nodes only whether the light reaches them.
uint views_of(Box box, uint height, uint i) {
  if (!light_meets_box(light, box)) return 0u;
  uint all = (1u << light.view_count) - 1u;
  if (height > 0u || light.views != ViewsCube || !masks_views) return all;
  // The projection of the vertices rounds differently from that of the box.
  vec3 slack = max(abs(box.lo - light.position_ws), abs(box.hi - light.position_ws)) * 1e-5;
  return face_mask(box.lo - light.position_ws - slack, box.hi - light.position_ws + slack) & all;
}
