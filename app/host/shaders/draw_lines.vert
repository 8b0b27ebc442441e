// A box of receivers on the virtual cube of a light (P2): the box, the light, the cube, the box's silhouette on every face
// that sees it, and the rays that cast it there. Six vertices a line, which is as wide as the picture asks for.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#define UMBRAGE_SET 2
#include "umbrage/shaders/umbrage.glsl"
layout(push_constant, scalar) uniform Push { ShowPush push; };
layout(location = 0) out vec4 color;
layout(location = 1) noperspective out float line_depth;

struct Line {
  vec3 a_ws, b_ws;
  vec4 color;     // a = 0: not drawn.
  float width;    // In units of the picture's line.
};

const uint first_cube_line = 12u, first_rect_line = 24u, first_ray_line = 48u, first_light_line = 56u;
const vec4 box_color = vec4(1.0, 0.85, 0.2, 1.0), cube_color = vec4(0.35, 0.75, 1.0, 0.9), rect_color = vec4(1.0, 0.25, 0.45, 1.0),
           ray_color = vec4(1.0, 0.85, 0.2, 0.35), light_color = vec4(1.0, 1.0, 1.0, 1.0);

// Edge e runs along axis e / 4 from the corner that the two low bits of e choose on the other axes.
vec3 corner_of_edge(uint edge, uint end) {
  uint axis = edge / 4u;
  vec3 corner;
  corner[axis] = float(end);
  corner[(axis + 1u) % 3u] = float(edge & 1u);
  corner[(axis + 2u) % 3u] = float(edge >> 1 & 1u);
  return corner;
}

/// Half the side of the virtual cube: it stands between the light and the box; around the box when the light is in it.
float cube_half_side(GpuSubject subject) {
  vec3 apart = max(max(subject.box_low - subject.light_ws, subject.light_ws - subject.box_high), vec3(0.0));
  float nearest = max(max(apart.x, apart.y), apart.z);
  vec3 half_size = 0.5 * (subject.box_high - subject.box_low);
  float largest = max(max(half_size.x, half_size.y), half_size.z);
  return nearest > 0.1 * largest ? 0.5 * nearest : 2.5 * largest;
}

Line rect_line(GpuSubject subject, float side, uint index) {
  uint face = index / 4u, edge = index % 4u;
  UmbrageFaceRect rect;
  if (!umbrage_project_box_to_face(face, subject.box_low - subject.light_ws, subject.box_high - subject.light_ws, rect)) {
    return Line(vec3(0.0), vec3(0.0), vec4(0.0), 0.0);
  }
  vec2 low = rect.min_st, high = rect.max_st;
  vec2 corners[4] = vec2[](low, vec2(high.x, low.y), high, vec2(low.x, high.y));
  vec2 a = corners[edge], b = corners[(edge + 1u) % 4u];
  vec3 from = subject.light_ws, to_a = umbrage_face_direction(face, a.x, a.y), to_b = umbrage_face_direction(face, b.x, b.y);
  return Line(from + side * to_a, from + side * to_b, rect_color, 1.6);
}

Line line_at(GpuSubject subject, uint index) {
  vec3 light = subject.light_ws;
  float side = cube_half_side(subject);
  if (index < first_cube_line) {
    return Line(mix(subject.box_low, subject.box_high, corner_of_edge(index, 0u)),
                mix(subject.box_low, subject.box_high, corner_of_edge(index, 1u)), box_color, 1.3);
  }
  if (index < first_rect_line) {
    uint edge = index - first_cube_line;
    vec3 a = 2.0 * corner_of_edge(edge, 0u) - 1.0, b = 2.0 * corner_of_edge(edge, 1u) - 1.0;
    return Line(light + side * a, light + side * b, cube_color, 1.0);
  }
  if (index < first_ray_line) return rect_line(subject, side, index - first_rect_line);
  if (index < first_light_line) {
    uint corner = index - first_ray_line;
    return Line(light, mix(subject.box_low, subject.box_high, vec3(corner & 1u, corner >> 1 & 1u, corner >> 2)), ray_color, 0.7);
  }
  vec3 arm = vec3(0.0);
  arm[index - first_light_line] = 0.2 * side;
  return Line(light - arm, light + arm, light_color, 1.6);
}

void main() {
  Frame frame = Frame(push.frame);
  GpuSubject subject = Subject(push.subject).data;
  Line line = line_at(subject, gl_VertexIndex / 6u);
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
  color = line.color;
  line_depth = 0.0;
  if (subject.light == NoLight || line.color.a == 0.0) return;

  // Cut off at the camera, then widened across its way over the picture.
  vec4 a = frame.data.clip_from_offset * vec4(line.a_ws - frame.data.eye_ws, 1.0);
  vec4 b = frame.data.clip_from_offset * vec4(line.b_ws - frame.data.eye_ws, 1.0);
  float from_a = a.w - a.z, from_b = b.w - b.z;   // Distance behind the near plane, by which clip space scales.
  if (from_a <= 0.0 && from_b <= 0.0) return;
  if (from_a < 0.0) a = mix(a, b, from_a / (from_a - from_b));
  if (from_b < 0.0) b = mix(b, a, from_b / (from_b - from_a));
  vec2 half_size = 0.5 * vec2(frame.data.width, frame.data.height);
  vec2 along = (b.xy / b.w - a.xy / a.w) * half_size;
  along = length(along) > 1e-4 ? normalize(along) : vec2(1.0, 0.0);
  uint corner = uint[](0u, 1u, 2u, 2u, 1u, 3u)[gl_VertexIndex % 6u];
  vec4 end = (corner & 1u) == 0u ? a : b;
  float line_px = max(line.width * float(frame.data.height) / 400.0, 1.0);
  vec2 across = vec2(-along.y, along.x) * (0.5 * line_px) * ((corner & 2u) == 0u ? -1.0 : 1.0);
  line_depth = end.z / end.w;
  // In front of everything: the fragment shader compares.
  gl_Position = vec4(end.xy / end.w + across / half_size, 1.0, 1.0);
}
