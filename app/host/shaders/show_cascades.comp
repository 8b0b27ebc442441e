// The cascades of one light as figures 3 and 4 of "CSM Scrolling" have them. Columns: cascades, near to far. Rows: the finished maps,
// grey; what was taken over from the frame before, blue; what was drawn onto that, red.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#define UMBRAGE_SET 2
#define UMBRAGE_DEBUG
#include "umbrage/shaders/umbrage.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ShowPush push; };
#include "legend.glsl"

const int rows = 3;
const int gap_px = 4;
const vec3 paper = vec3(0.25);

/// The first light with cascades, or the one asked for; NoLight: there is none.
uint shown_light(UmbrageFrame shadows) {
  UmbrageCluster all = UmbrageCluster(UmbrageNoIndex, UmbrageNoIndex, umbrage_light_count(shadows), 0u);
  for (uint i = 0u; i < all.count; ++i) {
    UmbrageLight light = umbrage_light(shadows, all, i);
    if ((push.light == NoLight || light.host_index == push.light) && umbrage_debug_cascade_count(shadows, light.index) > 0u) return light.index;
  }
  return NoLight;
}

void main() {
  Frame frame = Frame(push.frame);
  ivec2 size = ivec2(frame.data.width, frame.data.height);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  uint light = shown_light(shadows);
  vec3 shown = paper;
  if (light != NoLight) {
    int columns = int(umbrage_debug_cascade_count(shadows, light));
    int side_px = max(min((size.x - gap_px) / columns, (size.y - gap_px) / rows) - gap_px, 1);
    ivec2 cell = pixel / (side_px + gap_px);
    ivec2 place = pixel - cell * (side_px + gap_px) - gap_px;
    if (min(place.x, place.y) >= 0 && cell.x < columns && cell.y < rows) {
      uint side = umbrage_debug_cascade_side(shadows, light, uint(cell.x));
      uvec2 texel = min(uvec2((vec2(place) + 0.5) / float(side_px) * float(side)), uvec2(side - 1u));
      float height = umbrage_debug_cascade_heights(shadows, light, uint(cell.x), texel)[cell.y];
      vec3 tint = cell.y == 0 ? vec3(1.0) : cell.y == 1 ? vec3(0.45, 0.65, 1.0) : vec3(1.0, 0.40, 0.35);
      shown = height < 0.0 ? vec3(1.0) : tint * (0.85 - 0.75 * clamp(height, 0.0, 1.0));
    }
  }
  imageStore(picture_target, pixel, vec4(light == NoLight ? with_title(pixel, size, NoNumber, shown) : shown, 1.0));
}
