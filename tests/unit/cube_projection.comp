// The generated cube_projection.glsl as a host's shader sees it: included alone, and harmlessly twice.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "umbrage/shaders/cube_projection.glsl"
#include "umbrage/shaders/cube_projection.glsl"

layout(local_size_x = 6) in;
layout(std430, binding = 0) writeonly buffer Masks {
  uint face_mask;
  uvec2 rows[UmbrageCubeFaceCount * UmbrageMaxCubeTiles];
};
layout(push_constant) uniform Push {
  vec3 box_min;
  float bias_m;
  vec3 box_max;
  uint resolution;
};

void main() {
  uint face = gl_LocalInvocationIndex;
  float margin = umbrage_receiver_margin_m(box_min, box_max, resolution, 1.5f, bias_m);
  vec3 grown_min = box_min - margin;
  vec3 grown_max = box_max + margin;
  if (face == 0u) face_mask = umbrage_face_mask(grown_min, grown_max);
  for (uint row = 0u; row < UmbrageMaxCubeTiles; ++row) rows[face * UmbrageMaxCubeTiles + row] = uvec2(0u);
  UmbrageFaceBox box;
  if (!umbrage_clip_box_to_face(face, grown_min, grown_max, box)) return;
  UmbrageTileRect rect = umbrage_tile_rect(umbrage_face_rect(box), UmbrageMaxCubeTiles);
  for (uint row = rect.begin.y; row < rect.end.y; ++row) {
    uvec2 span = umbrage_tile_row_span(box, row, UmbrageMaxCubeTiles);
    rows[face * UmbrageMaxCubeTiles + row] = umbrage_tile_span_mask(span.x, span.y);
  }
}
