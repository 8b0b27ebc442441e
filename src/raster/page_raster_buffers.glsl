// Scratch of the page rasteriser by address, and drawing a block of a triangle's texels by one thread.
#include "raster/page_buffers.glsl"
#include "raster/triangle.glsl"

UMB_ARRAY(RasterTriangles, RasterTriangle, 4);
UMB_ARRAY(TileNodes, TileNode, 4);
UMB_ARRAY(RasterTiles, RasterTile, 4);
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Arguments { RasterArguments v; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FrameCount { FrameCounters v; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Appended { RasterCounts v; };

/// Number of the workgroup in a dispatch that plan_dispatches has folded.
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

/// Edge functions at a texel.
void start_edges(RasterTriangle t, uvec2 texel, out ivec3 edges, out vec3 fractions) {
  ivec2 at = ivec2(texel) * SubTexels + SubTexels / 2;
  ivec3 x = steps_x(t);
  ivec3 y = steps_y(t);
  EdgeStart first = start_edge(x.x, y.x, at.x - t.x1, at.y - t.y1);
  EdgeStart second = start_edge(x.y, y.y, at.x - t.x2, at.y - t.y2);
  EdgeStart third = start_edge(x.z, y.z, at.x - t.x0, at.y - t.y0);
  edges = ivec3(first.value, second.value, third.value);
  fractions = vec3(first.fraction, second.fraction, third.fraction);
}

/// First and last texel of a triangle's box on the map; first > last where it holds no texel's centre.
void texel_box(RasterTriangle t, uint resolution, out ivec2 first, out ivec2 last) {
  ivec2 lo = ivec2(min(t.x0, min(t.x1, t.x2)), min(t.y0, min(t.y1, t.y2)));
  ivec2 hi = ivec2(max(t.x0, max(t.x1, t.x2)), max(t.y0, max(t.y1, t.y2)));
  first = max(ivec2(first_texel(lo.x), first_texel(lo.y)), ivec2(0));
  last = min(ivec2(last_texel(hi.x), last_texel(hi.y)), ivec2(int(resolution) - 1));
}
