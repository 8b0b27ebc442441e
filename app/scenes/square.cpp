// What stands on the market square: stalls with their goods, and the fountain.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scenes/props.hpp"

namespace app {
namespace {

using glm::vec3;

void add_heap(MeshBuilder& builder, Mat goods, vec3 centre, float radius, int rings) {
  for (int ring = 0; ring < rings; ++ring) {
    const int count = std::max(1, 7 * (rings - 1 - ring));
    const float out = radius * 2 * static_cast<float>(rings - 1 - ring);
    for (int i = 0; i < count; ++i) {
      const float angle =
          6.2831853f * (static_cast<float>(i) + 0.5f * static_cast<float>(ring)) / static_cast<float>(count);
      builder.ball(goods,
                   centre + vec3(out * std::sin(angle), radius + 1.5f * radius * static_cast<float>(ring),
                                 out * std::cos(angle)),
                   radius, 6);
    }
  }
}

void add_roof_cloth(MeshBuilder& builder, Mat cloth, Detail detail) {
  const int strips = detail == Detail::low ? 2 : 9;
  const float half = 1.75f, front = 1.5f, back = -1.1f;
  const auto line = [&](float y_offset, float z, int i) {
    const float x = half * (2 * static_cast<float>(i) / static_cast<float>(strips) - 1);
    const float y = z > 1 ? 2.15f : z < -1 ? 2.3f : 2.95f;
    return vec3{x, y + y_offset, z};
  };
  for (int i = 0; i < strips; ++i) {
    const Mat mat = i % 2 ? Mat::cloth_white : cloth;
    for (const auto& [near_z, far_z] : {std::pair{front, 0.1f}, std::pair{0.1f, back}}) {
      builder.block(
          mat, {line(0, near_z, i), line(0, near_z, i + 1), line(0, far_z, i + 1), line(0, far_z, i),
                line(0.02f, near_z, i), line(0.02f, near_z, i + 1), line(0.02f, far_z, i + 1), line(0.02f, far_z, i)});
    }
    if (detail == Detail::low) continue;
    // A scalloped valance.
    const vec3 a = line(0.02f, front, i), b = line(0.02f, front, i + 1), m = (a + b) * 0.5f;
    const vec3 drop{0, -0.2f, 0.01f};
    builder.quad(mat, a + drop, b + drop, b, a);
    builder.triangle(mat, a + drop, m + 1.6f * drop, b + drop);
  }
}

}  // namespace

void add_market_stall(MeshBuilder& builder, Detail detail, Mat cloth) {
  for (float x : {-1.65f, 1.65f}) {
    builder.stand(Mat::timber, {x, -0.3f, 1.05f}, {0.09f, 2.65f, 0.09f});
    builder.stand(Mat::timber, {x, -0.3f, -1.0f}, {0.09f, 2.6f, 0.09f});
    builder.beam(Mat::timber, {x, 2.33f, 1.05f}, {x, 2.92f, 0.1f}, 0.07f, 0.07f);
    builder.beam(Mat::timber, {x, 2.28f, -1.0f}, {x, 2.92f, 0.1f}, 0.07f, 0.07f);
  }
  add_roof_cloth(builder, cloth, detail);
  builder.box(Mat::plank, {-1.6f, 0.78f, -0.1f}, {1.6f, 0.84f, 0.95f});
  builder.box(cloth, {-1.6f, 0.3f, 0.955f}, {1.6f, 0.82f, 0.97f});
  for (float x : {-1.45f, 1.45f}) {
    for (float z : {0.0f, 0.85f}) builder.stand(Mat::timber, {x, -0.3f, z}, {0.08f, 1.08f, 0.08f});
  }
  builder.box(Mat::plank, {-1.6f, 1.25f, -0.98f}, {1.6f, 1.3f, -0.62f});
  if (detail == Detail::low) return;
  const std::array goods{Mat::fruit_orange, Mat::fruit_green, Mat::cloth_red, Mat::straw};
  for (int i = 0; i < 4; ++i) {
    const float x = -1.2f + 0.8f * static_cast<float>(i);
    builder.box(Mat::timber, {x - 0.36f, 0.84f, 0.12f}, {x + 0.36f, 0.92f, 0.85f});
    add_heap(builder, goods[static_cast<size_t>(i)], {x, 0.91f, 0.48f}, 0.07f, 3);
    const auto scope = builder.at({x, 1.3f, -0.8f});
    builder.lathe(
        Mat::roof_brown,
        {{0.09f, 0}, {0.14f, 0.12f}, {0.13f, 0.22f}, {0.06f, 0.3f}, {0.08f, 0.36f}, {0.05f, 0.36f}, {0, 0.3f}}, 9);
  }
  for (float x : {-1.2f, -0.75f, 0.9f}) {
    const auto sack = builder.at({x, 0, -0.45f}, x);
    builder.lathe(
        Mat::straw,
        {{0.2f, -0.05f}, {0.26f, 0.1f}, {0.24f, 0.4f}, {0.1f, 0.6f}, {0.07f, 0.64f}, {0.14f, 0.74f}, {0, 0.7f}}, 9);
  }
}

void add_fountain(MeshBuilder& builder, Detail detail) {
  const int sides = detail == Detail::low ? 8 : 32;
  builder.lathe(Mat::trim, {{4.0f, -0.8f}, {4.0f, 0.12f}, {3.5f, 0.12f}, {3.5f, 0.28f}, {3.05f, 0.28f}}, 8);
  builder.lathe(Mat::stone, {{2.75f, 0.2f}, {2.75f, 0.85f}}, sides);
  builder.lathe(Mat::trim, {{3.05f, 0.28f}, {2.75f, 0.285f}}, 8);
  builder.lathe(Mat::trim, {{2.75f, 0.8f}, {2.9f, 0.85f}, {2.9f, 0.97f}, {2.45f, 0.97f}, {2.45f, 0.6f}}, sides);
  builder.lathe(Mat::water, {{2.45f, 0.72f}, {0.3f, 0.721f}}, sides);
  builder.lathe(Mat::trim,
                {{0.75f, 0.6f},
                 {0.7f, 0.9f},
                 {0.4f, 1.05f},
                 {0.32f, 1.9f},
                 {0.5f, 2.05f},
                 {1.15f, 2.3f},
                 {1.25f, 2.42f},
                 {1.1f, 2.42f},
                 {0.9f, 2.3f}},
                sides);
  builder.lathe(Mat::water, {{0.95f, 2.335f}, {0.2f, 2.336f}}, sides);
  builder.lathe(Mat::trim,
                {{0.3f, 2.25f},
                 {0.2f, 2.5f},
                 {0.16f, 3.1f},
                 {0.3f, 3.25f},
                 {0.34f, 3.35f},
                 {0.12f, 3.45f},
                 {0.2f, 3.6f},
                 {0.1f, 3.85f},
                 {0, 3.95f}},
                sides);
  const int jets = detail == Detail::low ? 0 : 8;
  for (int i = 0; i < jets; ++i) {
    const float angle = 0.7853982f * static_cast<float>(i);
    std::array<vec3, 8> arc;
    std::array<float, 8> radii;
    for (size_t k = 0; k < arc.size(); ++k) {
      const float t = static_cast<float>(k) / 7, out = 1.15f + 0.85f * t;
      arc[k] = {out * std::sin(angle), 2.42f + 0.25f * t - 1.95f * t * t, out * std::cos(angle)};
      radii[k] = 0.022f + 0.012f * t;
    }
    builder.tube(Mat::water, arc, radii, 5);
  }
  for (int i = 0; i < 8; ++i) {
    const float angle = 0.7853982f * (static_cast<float>(i) + 0.5f);
    const auto scope = builder.at({3.75f * std::sin(angle), 0.1f, 3.75f * std::cos(angle)});
    builder.lathe(Mat::trim, {{0.16f, 0}, {0.16f, 0.6f}, {0.22f, 0.66f}, {0.18f, 0.8f}, {0, 0.88f}},
                  detail == Detail::low ? 4 : 10);
  }
}

}  // namespace app
