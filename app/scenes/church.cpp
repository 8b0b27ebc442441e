// The church: nave, buttresses, tower with an open belfry, clock and spire.
#include <array>
#include <cmath>

#include "scenes/house.hpp"

namespace app {
namespace {

using glm::vec3;

constexpr float nave_half = 4.5f, nave_length = 20, nave_eave = 7.5f;
constexpr float tower_half = 2.8f, belfry_floor = 15.5f, belfry_top = 19.2f, spire_top = 31;

/// A lancet on the wall z = 0: a lit pane under a pointed head between stone bars.
void add_lancet(MeshBuilder& builder, float x, float y, float width, float height, Mat pane, Detail detail) {
  const auto scope = builder.at({x, y, 0});
  const float w = width / 2, head = width * 0.9f;
  builder.picture(pane, {-w, 0, 0.03f}, {w, 0, 0.03f}, {w, height, 0.03f}, {-w, height, 0.03f});
  builder.triangle(pane, {-w, height, 0.03f}, {w, height, 0.03f}, {0, height + head, 0.03f});
  if (detail == Detail::low) return;
  for (float side : {-1.0f, 1.0f}) {
    builder.box(Mat::trim, {side * (w + 0.09f) - 0.09f, -0.1f, -0.05f}, {side * (w + 0.09f) + 0.09f, height, 0.16f});
    builder.beam(Mat::trim, {side * (w + 0.09f), height - 0.02f, 0.055f}, {0, height + head + 0.12f, 0.055f}, 0.18f,
                 0.21f);
  }
  builder.box(Mat::trim, {-w - 0.25f, -0.25f, -0.05f}, {w + 0.25f, -0.1f, 0.22f});
  builder.box(Mat::iron, {-0.025f, 0, 0.03f}, {0.025f, height + head * 0.9f, 0.07f});
  for (float bar = 0.5f; bar < height; bar += 0.5f)
    builder.box(Mat::iron, {-w, bar - 0.015f, 0.03f}, {w, bar + 0.015f, 0.06f});
}

void add_nave(MeshBuilder& builder, Detail detail, Random& random) {
  builder.box(Mat::trim, {-nave_half - 0.12f, -1.6f, -nave_length - 0.12f}, {nave_half + 0.12f, 0.25f, 0.12f});
  const Roof roof{.kind = RoofKind::gable_front,
                  .left = -nave_half,
                  .right = nave_half,
                  .back = -nave_length,
                  .front = 0,
                  .eave = nave_eave,
                  .pitch = 1.35f,
                  .overhang = 0.4f,
                  .tiles = Mat::roof_slate};
  for (int side = 0; side < 4; ++side) {
    const bool facing_z = side % 2 == 0;
    const Wall wall{.width = facing_z ? 2 * nave_half : nave_length,
                    .bottom = 0,
                    .top = nave_eave,
                    .mat = Mat::stone,
                    .gable = facing_z ? std::optional(roof.apex()) : std::nullopt,
                    .openings = {}};
    const std::array<vec3, 4> middles{
        vec3{0, 0, 0}, {nave_half, 0, -nave_length / 2}, {0, 0, -nave_length}, {-nave_half, 0, -nave_length / 2}};
    const auto scope = builder.at(middles[static_cast<size_t>(side)], 1.5707963f * static_cast<float>(side));
    add_wall(builder, wall, detail, random);
    if (side == 2) add_lancet(builder, 0, 3, 1.6f, 3.6f, Mat::window_warm, detail);
    if (facing_z) continue;
    for (int bay = 0; bay < 5; ++bay) {
      const float x = (static_cast<float>(bay) - 2) * 3.9f;
      add_lancet(builder, x, 2.2f, 1.0f, 2.7f, bay % 2 ? Mat::window_warm : Mat::window_bright, detail);
      if (bay == 4) continue;
      builder.stand(Mat::trim, {x + 1.95f, -1.2f, 0.4f}, {0.7f, 5.2f, 0.8f});
      builder.block(Mat::trim, {vec3{x + 1.6f, 4, 0.8f},
                                {x + 2.3f, 4, 0.8f},
                                {x + 2.3f, 4, 0},
                                {x + 1.6f, 4, 0},
                                {x + 1.6f, 4.05f, 0.8f},
                                {x + 2.3f, 4.05f, 0.8f},
                                {x + 2.3f, 6.2f, 0},
                                {x + 1.6f, 6.2f, 0}});
    }
  }
  add_roof(builder, roof, detail, random);
}

/// Corner piers with a parapet and a floor below, open on four sides, slatted.
void add_belfry(MeshBuilder& builder, Detail detail) {
  const float h = tower_half, pier = 0.75f;
  for (float x : {-1.0f, 1.0f}) {
    for (float z : {-1.0f, 1.0f}) {
      const vec3 corner{x * (h - pier / 2), belfry_floor, z * (h - pier / 2)};
      builder.stand(Mat::trim, corner, {pier, belfry_top - belfry_floor, pier});
    }
  }
  for (int side = 0; side < 4; ++side) {
    const auto scope = builder.at({0, belfry_floor, 0}, 1.5707963f * static_cast<float>(side));
    builder.box(Mat::trim, {-h + pier, 0, h - 0.3f}, {h - pier, 0.7f, h - 0.05f});
    builder.box(Mat::stone, {-h + pier, 3.0f, h - 0.45f}, {h - pier, belfry_top - belfry_floor, h - 0.02f});
    if (detail == Detail::low) continue;
    for (float x : {-0.7f, 0.7f}) builder.stand(Mat::trim, {x, 0.7f, h - 0.2f}, {0.16f, 2.3f, 0.2f});
  }
  builder.box(Mat::timber, {-h + 0.2f, belfry_top - 0.35f, -0.12f}, {h - 0.2f, belfry_top - 0.1f, 0.12f});
  const auto scope = builder.at({0, belfry_top - 1.35f, 0});
  builder.lathe(Mat::gold,
                {{0, 0.1f}, {0.5f, 0}, {0.62f, 0.02f}, {0.42f, 0.5f}, {0.34f, 0.85f}, {0.1f, 1.0f}, {0, 1.02f}},
                detail == Detail::low ? 6 : 14);
}

void add_clock(MeshBuilder& builder, Detail detail) {
  const int steps = detail == Detail::low ? 8 : 24;
  const auto turned = glm::mat4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);  // The lathe's axis along z.
  const auto scope = builder.frame(turned);
  builder.lathe(Mat::trim, {{1.25f, 0}, {1.25f, 0.1f}, {1.05f, 0.12f}}, steps);
  builder.lathe(Mat::dial, {{1.05f, 0.06f}, {0, 0.061f}}, steps);
  builder.beam(Mat::iron, {0, 0.09f, 0}, {0.25f, 0.09f, -0.75f}, 0.07f, 0.03f);
  builder.beam(Mat::iron, {0, 0.09f, 0}, {0.5f, 0.09f, 0.15f}, 0.08f, 0.03f);
  if (detail == Detail::low) return;
  for (int i = 0; i < 12; ++i) {
    const float angle = 0.5235988f * static_cast<float>(i);
    const vec3 out{std::sin(angle), 0, std::cos(angle)};
    builder.beam(Mat::iron, out * 0.82f + vec3(0, 0.075f, 0), out * 0.98f + vec3(0, 0.075f, 0), 0.05f, 0.02f);
  }
}

void add_tower(MeshBuilder& builder, Detail detail, Random& random) {
  const float h = tower_half;
  builder.box(Mat::trim, {-h - 0.2f, -1.6f, -h - 0.2f}, {h + 0.2f, 0.25f, h + 0.2f});
  for (int side = 0; side < 4; ++side) {
    const auto turned = builder.at({0, 0, 0}, 1.5707963f * static_cast<float>(side));
    const auto scope = builder.at({0, 0, h});
    Wall wall{.width = 2 * h, .bottom = 0, .top = belfry_floor, .mat = Mat::stone, .gable = {}, .openings = {}};
    if (side == 0) {
      wall.openings.push_back({.kind = OpeningKind::door,
                               .y = 0.27f,
                               .width = 1.7f,
                               .height = 3.1f,
                               .pane = Mat::window_warm,
                               .frame = Mat::paint_red});
    }
    add_wall(builder, wall, detail, random);
    if (side != 2) add_lancet(builder, 0, 5.2f, 0.8f, 2.2f, Mat::window_warm, detail);
    const auto clock = builder.at({0, 12.2f, 0});
    add_clock(builder, detail);
  }
  for (float y : {9.6f, belfry_floor - 0.15f})
    builder.box(Mat::trim, {-h - 0.14f, y, -h - 0.14f}, {h + 0.14f, y + 0.25f, h + 0.14f});
  add_belfry(builder, detail);
  builder.box(Mat::trim, {-h - 0.25f, belfry_top, -h - 0.25f}, {h + 0.25f, belfry_top + 0.3f, h + 0.25f});
  const float o = h + 0.45f, foot = belfry_top + 0.2f;
  const std::array<vec3, 4> corners{vec3{-o, foot, o}, {o, foot, o}, {o, foot, -o}, {-o, foot, -o}};
  const vec3 tip{0, spire_top, 0};
  for (size_t i = 0; i < 4; ++i) {
    add_slope(builder, Mat::roof_slate, {corners[i], corners[(i + 1) % 4], tip, tip}, detail, random);
    add_ridge(builder, Mat::roof_slate, corners[i], tip, detail);
  }
  builder.ball(Mat::gold, {0, spire_top + 0.25f, 0}, 0.28f, detail == Detail::low ? 6 : 10);
  builder.stand(Mat::gold, {0, spire_top + 0.4f, 0}, {0.07f, 1.5f, 0.07f});
  builder.box(Mat::gold, {-0.4f, spire_top + 1.3f, -0.035f}, {0.4f, spire_top + 1.37f, 0.035f});
}

}  // namespace

void add_church(MeshBuilder& builder, Detail detail) {
  Random random(97);
  add_nave(builder, detail, random);
  const auto scope = builder.at({0, 0, tower_half - 0.1f});
  add_tower(builder, detail, random);
}

}  // namespace app
