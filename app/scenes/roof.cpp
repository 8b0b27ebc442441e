// A row of tiles rests with its upper edge on the boards and with its lower edge on the row below; each tile has its
// own stain.
#include "scenes/roof.hpp"

#include <algorithm>
#include <cmath>

namespace app {
namespace {

using glm::vec3;

constexpr float board_m = 0.10f, tile_length_m = 0.58f, tile_width_m = 0.5f, tile_lift_m = 0.05f;

/// Boards along the gable ends of a slope; they close the rows of tiles.
void add_bargeboards(MeshBuilder& builder, const Slope& s) {
  const vec3 along = glm::normalize(s.eave_right - s.eave_left);
  builder.beam(Mat::timber, s.eave_left, s.ridge_left, 0.07f, 0.26f, along);
  builder.beam(Mat::timber, s.eave_right, s.ridge_right, 0.07f, 0.26f, along);
}

void add_gables(MeshBuilder& builder, const Roof& roof, float reach, bool along_x, Detail detail, Random& random) {
  const float o = roof.overhang, top = roof.apex() + 0.02f;
  const float eave = roof.eave - roof.pitch * o + 0.02f;
  const auto slope = [&](const Slope& half) {
    add_slope(builder, roof.tiles, half, detail, random);
    if (detail == Detail::full) add_bargeboards(builder, half);
  };
  if (along_x) {
    const float l = roof.left - reach, r = roof.right + reach, mid = (roof.front + roof.back) / 2;
    slope({{l, eave, roof.front + o}, {r, eave, roof.front + o}, {r, top, mid}, {l, top, mid}});
    slope({{r, eave, roof.back - o}, {l, eave, roof.back - o}, {l, top, mid}, {r, top, mid}});
    add_ridge(builder, roof.tiles, {l, top, mid}, {r, top, mid}, detail);
    return;
  }
  const float f = roof.front + reach, b = roof.back - reach, mid = (roof.left + roof.right) / 2;
  slope({{roof.right + o, eave, f}, {roof.right + o, eave, b}, {mid, top, b}, {mid, top, f}});
  slope({{roof.left - o, eave, b}, {roof.left - o, eave, f}, {mid, top, f}, {mid, top, b}});
  add_ridge(builder, roof.tiles, {mid, top, b}, {mid, top, f}, detail);
}

void add_hip(MeshBuilder& builder, const Roof& roof, Detail detail, Random& random) {
  const float o = roof.overhang, eave = roof.eave - roof.pitch * o + 0.02f, top = roof.apex() + 0.02f;
  const float half = (roof.front - roof.back) / 2, mid = (roof.front + roof.back) / 2;
  const vec3 fl{roof.left - o, eave, roof.front + o}, fr{roof.right + o, eave, roof.front + o};
  const vec3 bl{roof.left - o, eave, roof.back - o}, br{roof.right + o, eave, roof.back - o};
  const vec3 l{roof.left + half, top, mid}, r{roof.right - half, top, mid};
  add_slope(builder, roof.tiles, {fl, fr, r, l}, detail, random);
  add_slope(builder, roof.tiles, {fr, br, r, r}, detail, random);
  add_slope(builder, roof.tiles, {br, bl, l, r}, detail, random);
  add_slope(builder, roof.tiles, {bl, fl, l, l}, detail, random);
  add_ridge(builder, roof.tiles, l, r, detail);
  for (vec3 corner : {fl, bl}) add_ridge(builder, roof.tiles, corner, l, detail);
  for (vec3 corner : {fr, br}) add_ridge(builder, roof.tiles, corner, r, detail);
}

}  // namespace

float Roof::apex() const {
  const float run = kind == RoofKind::gable_front ? (right - left) / 2 : (front - back) / 2;
  return eave + pitch * run;
}

void add_slope(MeshBuilder& builder, Mat tiles, const Slope& s, Detail detail, Random& random) {
  const vec3 normal = glm::normalize(glm::cross(s.ridge_right - s.eave_left, s.ridge_left - s.eave_right));
  const vec3 down = normal * board_m;
  const Mat boards = detail == Detail::low ? tiles : Mat::timber;
  builder.block(boards, {s.eave_left - down, s.eave_right - down, s.ridge_right - down, s.ridge_left - down,
                         s.eave_left, s.eave_right, s.ridge_right, s.ridge_left});
  if (detail == Detail::low) return;
  const float length = glm::distance((s.eave_left + s.eave_right) * 0.5f, (s.ridge_left + s.ridge_right) * 0.5f);
  const int rows = std::max(1, static_cast<int>(std::lround(length / tile_length_m)));
  for (int row = 0; row < rows; ++row) {
    const float low = static_cast<float>(row) / static_cast<float>(rows) - (row == 0 ? 0.1f / length : 0);
    const float high = static_cast<float>(row + 1) / static_cast<float>(rows);
    const vec3 left = glm::mix(s.eave_left, s.ridge_left, low), right = glm::mix(s.eave_right, s.ridge_right, low);
    const vec3 top_left = glm::mix(s.eave_left, s.ridge_left, high),
               top_right = glm::mix(s.eave_right, s.ridge_right, high);
    const int columns = std::max(1, static_cast<int>(std::lround(glm::distance(left, right) / tile_width_m)));
    const float shift = row % 2 ? 0.5f : 0.0f;
    const vec3 lift = normal * (tile_lift_m + random.around(0.012f)), rest = normal * 0.006f;
    builder.quad(tiles, left, right, right + lift, left + lift);
    for (int column = 0; column < columns + row % 2; ++column) {
      const float a = std::max(0.0f, (static_cast<float>(column) - shift) / static_cast<float>(columns));
      const float b = std::min(1.0f, (static_cast<float>(column) + 1 - shift) / static_cast<float>(columns));
      builder.stained_quad(tiles, glm::mix(left, right, a) + lift, glm::mix(left, right, b) + lift,
                           glm::mix(top_left, top_right, b) + rest, glm::mix(top_left, top_right, a) + rest,
                           {random.unit(), random.unit()});
    }
  }
}

void add_ridge(MeshBuilder& builder, Mat tiles, vec3 from, vec3 to, Detail detail) {
  if (detail == Detail::low) return;
  const float length = glm::distance(from, to);
  if (length < 0.3f) return;
  const vec3 along = (to - from) / length, side = glm::normalize(glm::cross(along, vec3(0, 1, 0)));
  const vec3 up = glm::cross(side, along);
  const int count = std::max(1, static_cast<int>(length / 0.42f));
  const auto ring = [&](float t, float scale, float lift) {
    const vec3 centre = from + along * t + up * lift;
    return std::array{centre - side * 0.17f * scale - up * 0.12f, centre - side * 0.09f * scale + up * 0.07f * scale,
                      centre + side * 0.09f * scale + up * 0.07f * scale, centre + side * 0.17f * scale - up * 0.12f};
  };
  for (int i = 0; i < count; ++i) {
    const float step = length / static_cast<float>(count), t = step * static_cast<float>(i);
    const auto a = ring(t, 1.1f, 0.035f), b = ring(t + step * 1.06f, 0.95f, 0.005f);
    for (size_t k = 0; k < 3; ++k) builder.quad(tiles, a[k], a[k + 1], b[k + 1], b[k]);
    builder.quad(tiles, a[3], a[2], a[1], a[0]);
  }
}

void add_roof(MeshBuilder& builder, const Roof& roof, Detail detail, Random random) {
  switch (roof.kind) {
    case RoofKind::gable_side:
      add_gables(builder, roof, 0.3f, true, detail, random);
      break;
    case RoofKind::gable_front:
      add_gables(builder, roof, 0.35f, false, detail, random);
      break;
    case RoofKind::hip:
      add_hip(builder, roof, detail, random);
      break;
  }
}

void add_dormer(MeshBuilder& builder, const Roof& roof, float x, Mat wall, Mat frame, Detail detail, Random& random) {
  const float inset = 0.75f, width = 1.35f, height = 1.3f;
  const float base = roof.eave + roof.pitch * inset - 0.05f;
  const auto scope = builder.at({x, base, roof.front - inset});
  const float depth = (height + width / 2) / roof.pitch + 0.3f;
  builder.quad(wall, {-width / 2, -0.4f, -depth}, {-width / 2, -0.4f, 0}, {-width / 2, height, 0},
               {-width / 2, height, -depth});
  builder.quad(wall, {width / 2, -0.4f, 0}, {width / 2, -0.4f, -depth}, {width / 2, height, -depth},
               {width / 2, height, 0});
  Roof little{.kind = RoofKind::gable_front,
              .left = -width / 2,
              .right = width / 2,
              .back = 0.35f - depth,
              .front = 0,
              .eave = height,
              .pitch = 0.9f,
              .overhang = 0.2f,
              .tiles = roof.tiles};
  Wall front{.width = width, .bottom = -0.4f, .top = height, .mat = wall, .gable = little.apex()};
  front.openings.push_back({.y = 0.15f, .width = 0.8f, .height = 1.0f, .pane = pick_pane(random), .frame = frame});
  add_wall(builder, front, detail, random);
  add_roof(builder, little, detail, random);
}

void add_chimney(MeshBuilder& builder, float x, float z, float bottom, float top, Detail detail) {
  builder.box(Mat::stone, {x - 0.38f, bottom, z - 0.3f}, {x + 0.38f, top, z + 0.3f});
  if (detail == Detail::low) return;
  builder.box(Mat::trim, {x - 0.46f, top - 0.12f, z - 0.38f}, {x + 0.46f, top + 0.03f, z + 0.38f});
  for (float side : {-0.18f, 0.18f}) {
    const auto scope = builder.at({x + side, top + 0.03f, z});
    builder.lathe(Mat::roof_red, {{0.13f, 0}, {0.10f, 0.35f}, {0.13f, 0.40f}, {0.09f, 0.41f}, {0, 0.38f}}, 8);
  }
}

}  // namespace app
