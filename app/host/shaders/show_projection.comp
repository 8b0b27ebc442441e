// The maps of one light, each unfolded as a cross: its 32x32 tiles with receivers, as bright as the farthest of them is far
// (steps of equal ratio up to the light's range), and its pages.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
#define UMBRAGE_SET 2
#define UMBRAGE_DEBUG
#include "umbrage/shaders/umbrage.glsl"
#include "palette.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { ShowPush push; };
#include "legend.glsl"

const vec3 ground = vec3(0.10, 0.11, 0.13), face_color = vec3(0.17, 0.18, 0.21), page_color = vec3(0.10, 0.30, 0.36),
           page_edge = vec3(0.25, 0.75, 0.80), near_color = vec3(0.36, 0.16, 0.08), far_color = vec3(1.0, 0.93, 0.70);
const float depth_ratio = 32.0;   // Of the brightest and the darkest tile.

/// Maps in a grid of cells; a cell holds a heading and a cross of faces, 4 wide and 3 high (a spot: one view).
struct Layout {
  ivec2 cell;
  int columns, face, heading;
};

Layout lay_out(ivec2 size, uint maps, bool cube) {
  int scale = text_scale(size);
  size.y -= 6 * 3 * scale;
  ivec2 faces = cube ? ivec2(4, 3) : ivec2(1, 1);
  Layout best = Layout(ivec2(1), 1, 0, 9 * scale);
  for (int columns = 1; columns <= int(maps); ++columns) {
    int rows = (int(maps) + columns - 1) / columns;
    ivec2 cell = size / ivec2(columns, rows);
    ivec2 room = (cell - ivec2(8, best.heading + 8)) / faces;
    int face = max(min(room.x, room.y), 1);
    if (face > best.face) best = Layout(cell, columns, face, best.heading);
  }
  return best;
}

/// Where a face lies in the cross: neighbours continue each other over the edge that they share.
ivec2 face_place(uint face) {
  const ivec2 places[6] = ivec2[](ivec2(2, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 2), ivec2(1, 1), ivec2(3, 1));
  return places[face];
}

vec3 tile_color(UmbrageFrame shadows, UmbrageDebugMap map, uint view, vec2 place, float range_m, bool ortho) {
  float depth = umbrage_debug_receiver_depth(shadows, map, view, place);
  if (map.whole) return vec3(0.5);
  float share = ortho ? depth : 1.0 + log2(max(depth, 1e-9) / range_m) / log2(depth_ratio);
  return mix(near_color, far_color, clamp(share, 0.0, 1.0));
}

/// A pixel of one face. at: its place in pixels on the face's `side`.
vec3 show_face(UmbrageFrame shadows, UmbrageDebugMap map, uint view, ivec2 at, int side, float range_m, bool ortho) {
  vec2 place = (vec2(at) + 0.5) / float(side);
  uvec2 tile = uvec2(place * 32.0);
  uvec2 page = uvec2(place * float(map.resolution)) / map.page_side;
  vec3 shown = face_color;
  bool marked = umbrage_debug_page_is_marked(shadows, map, view, page);
  if (marked) shown = page_color;
  if ((umbrage_debug_receiver_row(shadows, map, view, tile.y) >> tile.x & 1u) != 0u) {
    shown = tile_color(shadows, map, view, place, range_m, ortho);
    // A dark joint between tiles where there is room for it.
    if (side >= 128 && any(notEqual(uvec2((vec2(at) + 1.5) / float(side) * 32.0), tile))) shown *= 0.8;
  }
  bool fine = float(side) * float(map.page_side) / float(map.resolution) < 4.0;
  uvec2 after = uvec2((vec2(at) + 1.5) / float(side) * float(map.resolution)) / map.page_side;
  if (marked && !fine && (any(notEqual(after, page)) || any(equal(at, ivec2(0))))) shown = mix(shown, page_edge, 0.85);
  return shown;
}

bool in_face_name(ivec2 at, uint face, int scale) {
  ivec2 corner = ivec2(2 * scale);
  uint axis = 88u + face / 2u, direction = (face & 1u) == 0u ? 43u : 45u;   // X, Y, Z; +, -
  return in_char(at, corner, scale, direction) || in_char(at, corner + ivec2(char_width(scale), 0), scale, axis);
}

vec3 show_map(UmbrageFrame shadows, UmbrageDebugMap map, ivec2 at, Layout l, int scale, float range_m, bool ortho) {
  // R and the resolution above the cross.
  ivec2 heading = ivec2(0, scale);
  ivec2 number = heading + ivec2(2 * char_width(scale), 0);
  if (in_char(at, heading, scale, 82u) || in_number(at, number, scale, map.resolution)) return legend_ink;
  at.y -= l.heading;
  if (at.x < 0 || at.y < 0) return ground;
  ivec2 place = at / l.face, on_face = at % l.face;
  for (uint view = 0u; view < map.view_count; ++view) {
    if (place != (map.view_count == 1u ? ivec2(0) : face_place(view))) continue;
    if (any(equal(on_face, ivec2(l.face - 1)))) return ground;
    if (map.view_count > 1u && l.face >= 24 * scale && in_face_name(on_face, view, scale)) return legend_ink;
    return show_face(shadows, map, view, on_face, l.face - 1, range_m, ortho);
  }
  return ground;
}

void main() {
  Frame frame = Frame(push.frame);
  ivec2 size = ivec2(frame.data.width, frame.data.height);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  UmbrageFrame shadows = umbrage_frame(frame.data.umbrage);
  GpuSubject subject = Subject(push.subject).data;
  vec3 shown = ground;
  if (subject.light != NoLight) {
    GpuLight light = Lights(frame.data.lights).at[subject.light];
    uvec2 maps = umbrage_debug_light_maps(shadows, subject.slot);
    UmbrageDebugMap first = umbrage_debug_map_at(shadows, maps.x, subject.slot);
    Layout l = lay_out(size, maps.y, first.view_count > 1u);
    ivec2 cell = pixel / l.cell;
    uint index = uint(cell.y * l.columns + cell.x);
    if (cell.x < l.columns && index < maps.y) {
      UmbrageDebugMap map = umbrage_debug_map_at(shadows, maps.x + index, subject.slot);
      ivec2 used = (map.view_count > 1u ? ivec2(4, 3) : ivec2(1)) * l.face;
      ivec2 margin = ivec2(max((l.cell.x - used.x) / 2, 4), max((l.cell.y - used.y - l.heading) / 2, 4));
      shown = show_map(shadows, map, pixel - cell * l.cell - margin, l, text_scale(size), light.range_m, light.type == LightDirectional);
    }
  }
  imageStore(picture_target, pixel, vec4(with_title(pixel, size, subject.light, shown), 1.0));
}
