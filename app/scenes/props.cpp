// Furniture of streets and yards.
#include "scenes/props.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace app {
namespace {

using glm::vec3;

void add_barrel(MeshBuilder& builder, Detail detail) {
  if (detail == Detail::low) {
    builder.lathe(Mat::plank, {{0.28f, 0}, {0.36f, 0.45f}, {0.28f, 0.9f}, {0, 0.9f}}, 5);
    return;
  }
  builder.lathe(
      Mat::plank,
      {{0.28f, 0}, {0.345f, 0.27f}, {0.345f, 0.63f}, {0.28f, 0.9f}, {0.25f, 0.9f}, {0.25f, 0.86f}, {0, 0.86f}}, 9);
  for (float y : {0.14f, 0.7f}) {
    const float r = 0.365f - 0.38f * (y - 0.43f) * (y - 0.43f);
    builder.lathe(Mat::iron, {{r - 0.02f, y}, {r, y}, {r, y + 0.05f}, {r - 0.02f, y + 0.05f}}, 9);
  }
}

void add_crate(MeshBuilder& builder, float size, Mat goods, Detail detail, Random& random) {
  const float h = size / 2;
  if (detail == Detail::low) {
    builder.box(Mat::plank, {-h, 0, -h}, {h, size * 0.7f, h});
    return;
  }
  builder.box(Mat::plank, {-h + 0.02f, 0, -h + 0.02f}, {h - 0.02f, 0.03f, h - 0.02f});
  for (int side = 0; side < 4; ++side) {
    const auto scope = builder.at({}, 1.5707963f * static_cast<float>(side));
    for (int i = 0; i < 3; ++i) {
      const float y = 0.02f + static_cast<float>(i) * size * 0.235f;
      builder.box(Mat::plank, {-h, y, h - 0.03f}, {h - 0.03f, y + size * 0.2f, h});
    }
    builder.stand(Mat::timber, {-h + 0.055f, 0, h - 0.055f}, {0.05f, size * 0.72f, 0.05f});
  }
  const int across = std::max(2, static_cast<int>(size / 0.2f));
  const float step = (size - 0.1f) / static_cast<float>(across);
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      const vec3 at{(static_cast<float>(i) + 0.5f) * step - h + 0.05f, size * 0.62f + random.range(0, 0.04f),
                    (static_cast<float>(j) + 0.5f) * step - h + 0.05f};
      builder.ball(goods, at, step * 0.52f, 5);
    }
  }
}

/// A spoked wheel in the plane x = 0.
void add_wheel(MeshBuilder& builder, float radius, Detail detail) {
  const auto scope =
      builder.frame(glm::mat4(0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1));  // The lathe's axis along x.
  const float r = radius, half = 0.04f;
  builder.lathe(Mat::timber, {{r - 0.09f, -half}, {r, -half}, {r, half}, {r - 0.09f, half}, {r - 0.09f, -half}},
                detail == Detail::low ? 8 : 16);
  builder.lathe(Mat::timber, {{0, -0.1f}, {0.1f, -0.1f}, {0.1f, 0.1f}, {0, 0.1f}}, detail == Detail::low ? 4 : 10);
  const int spokes = detail == Detail::low ? 4 : 10;
  for (int i = 0; i < spokes; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(spokes);
    const vec3 out{std::sin(angle), 0, std::cos(angle)};
    builder.beam(Mat::timber, out * 0.08f, out * (r - 0.06f), 0.045f, 0.045f, {0, 1, 0});
  }
}

}  // namespace

void add_bench(MeshBuilder& builder, Detail detail) {
  for (float x : {-0.7f, 0.7f}) {
    builder.box(Mat::iron, {x - 0.03f, -0.1f, -0.25f}, {x + 0.03f, 0.42f, -0.19f});
    builder.box(Mat::iron, {x - 0.03f, -0.1f, 0.19f}, {x + 0.03f, 0.42f, 0.25f});
    builder.beam(Mat::iron, {x, 0.4f, -0.22f}, {x, 0.95f, -0.34f}, 0.06f, 0.05f);
  }
  const int slats = detail == Detail::low ? 1 : 4;
  const float depth = 0.5f / static_cast<float>(slats);
  for (int i = 0; i < slats; ++i) {
    const float z = -0.25f + depth * static_cast<float>(i);
    builder.box(Mat::plank, {-0.95f, 0.42f, z}, {0.95f, 0.46f, z + depth - 0.025f});
    if (i == 3) continue;
    const float y = 0.55f + 0.15f * static_cast<float>(i);
    builder.beam(Mat::plank, {-0.95f, y, -0.23f - (y - 0.42f) * 0.2f}, {0.95f, y, -0.23f - (y - 0.42f) * 0.2f}, 0.1f,
                 0.03f, {0, 1, -0.2f});
  }
}

void add_barrels(MeshBuilder& builder, Detail detail) {
  const std::array<vec3, 3> feet{vec3{-0.45f, 0, 0}, {0.32f, 0, -0.1f}, {0, 0, 0.62f}};
  for (vec3 foot : feet) {
    const auto scope = builder.at(foot, foot.x * 3);
    add_barrel(builder, detail);
  }
  const auto scope = builder.at({-0.05f, 0.905f, 0.02f}, 1);
  add_barrel(builder, detail);
}

void add_crates(MeshBuilder& builder, Detail detail) {
  Random random(41);
  struct Place {
    vec3 at;
    float turn, size;
    Mat goods;
  };
  const std::array<Place, 4> places{Place{{-0.42f, 0, 0}, 0.1f, 0.75f, Mat::straw},
                                    {{0.45f, 0, 0.05f}, -0.2f, 0.75f, Mat::fruit_green},
                                    {{0.3f, 0, 0.85f}, 0.5f, 0.55f, Mat::fruit_orange},
                                    {{-0.3f, 0.56f, 0}, 0.35f, 0.6f, Mat::fruit_orange}};
  for (const Place& p : places) {
    const auto scope = builder.at(p.at, p.turn);
    add_crate(builder, p.size, p.goods, detail, random);
  }
}

void add_cart(MeshBuilder& builder, Detail detail) {
  for (float x : {-0.85f, 0.85f}) {
    const auto scope = builder.at({x, 0.62f, 0});
    add_wheel(builder, 0.64f, detail);
  }
  builder.beam(Mat::timber, {-0.85f, 0.62f, 0}, {0.85f, 0.62f, 0}, 0.1f, 0.1f, {0, 1, 0});
  builder.box(Mat::plank, {-0.65f, 0.7f, -1.1f}, {0.65f, 0.76f, 1.1f});
  for (float x : {-0.55f, 0.55f}) builder.beam(Mat::timber, {x, 0.68f, -1.0f}, {x * 0.8f, 0.3f, 2.6f}, 0.09f, 0.08f);
  builder.beam(Mat::timber, {0.3f, 0.7f, 1.0f}, {0.3f, -0.1f, 1.1f}, 0.07f, 0.07f);
  const int rails = detail == Detail::low ? 2 : 7;
  for (float side : {-0.62f, 0.62f}) {
    for (int i = 0; i < rails; ++i) {
      const float z = -1.05f + 2.1f * static_cast<float>(i) / static_cast<float>(rails - 1);
      builder.beam(Mat::timber, {side, 0.74f, z}, {side * 1.2f, 1.3f, z}, 0.05f, 0.05f);
    }
    builder.beam(Mat::timber, {side * 1.2f, 1.3f, -1.15f}, {side * 1.2f, 1.3f, 1.15f}, 0.06f, 0.06f);
  }
  builder.lathe(Mat::straw, {{0.6f, 0.77f}, {0.6f, 0.95f}, {0.42f, 1.2f}, {0, 1.38f}}, detail == Detail::low ? 5 : 9);
  if (detail == Detail::low) return;
  Random random(42);
  for (int i = 0; i < 190; ++i) {
    const float angle = random.range(0, 6.2831853f), out = std::sqrt(random.unit());
    const vec3 root{0.6f * out * std::sin(angle), 0.95f + 0.42f * (1 - out * out), 0.75f * out * std::cos(angle)};
    const vec3 along{0.3f * std::sin(angle * 7), 0.14f, 0.3f * std::cos(angle * 7)};
    const vec3 normal = glm::normalize(vec3(root.x, 0.8f, root.z));
    builder.leaf(Mat::straw, root, along, glm::normalize(glm::cross(normal, along)) * 0.035f, normal);
  }
}

void add_well(MeshBuilder& builder, Detail detail) {
  const int sides = detail == Detail::low ? 8 : 16;
  builder.lathe(Mat::stone, {{1.0f, -0.6f}, {0.98f, 0.75f}}, sides);
  builder.lathe(Mat::trim, {{1.0f, 0.75f}, {1.08f, 0.77f}, {1.08f, 0.9f}, {0.72f, 0.9f}, {0.72f, 0.5f}}, sides);
  builder.lathe(Mat::water, {{0.72f, 0.5f}, {0, 0.501f}}, sides);
  for (float x : {-0.9f, 0.9f}) builder.stand(Mat::timber, {x, 0.85f, 0}, {0.13f, 1.55f, 0.13f});
  Random random(43);
  const Roof roof{.kind = RoofKind::gable_side,
                  .left = -1.0f,
                  .right = 1.0f,
                  .back = -0.7f,
                  .front = 0.7f,
                  .eave = 2.25f,
                  .pitch = 0.8f,
                  .overhang = 0.25f,
                  .tiles = Mat::roof_brown};
  for (float x : {-0.98f, 0.92f})
    builder.block(Mat::plank, {vec3{x, 2.25f, 0.7f},
                               {x + 0.06f, 2.25f, 0.7f},
                               {x + 0.06f, 2.25f, -0.7f},
                               {x, 2.25f, -0.7f},
                               {x, 2.79f, 0.03f},
                               {x + 0.06f, 2.79f, 0.03f},
                               {x + 0.06f, 2.79f, -0.03f},
                               {x, 2.79f, -0.03f}});
  add_roof(builder, roof, detail, random);
  builder.rod(Mat::timber, {-1.05f, 1.6f, 0}, {1.05f, 1.6f, 0}, 0.08f, detail == Detail::low ? 4 : 8);
  builder.beam(Mat::iron, {1.06f, 1.6f, 0}, {1.06f, 1.3f, 0.25f}, 0.03f, 0.03f);
  builder.rod(Mat::straw, {0.1f, 1.15f, 0.08f}, {0.1f, 1.6f, 0.08f}, 0.012f, 4);
  const auto scope = builder.at({0.1f, 0.88f, 0.08f});
  builder.lathe(Mat::plank, {{0, 0}, {0.13f, 0}, {0.17f, 0.28f}, {0.14f, 0.28f}, {0.11f, 0.05f}, {0, 0.05f}},
                detail == Detail::low ? 5 : 10);
}

void add_firewood(MeshBuilder& builder, Detail detail) {
  if (detail == Detail::low) {
    builder.box(Mat::bark, {-1.1f, -0.1f, -0.3f}, {1.1f, 0.95f, 0.3f});
    return;
  }
  Random random(47);
  for (int row = 0; row < 6; ++row) {
    const int logs = 13 - row % 2;
    for (int i = 0; i < logs; ++i) {
      const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(logs - 1)) * 0.175f,
                  y = 0.085f + 0.155f * static_cast<float>(row);
      const float shift = random.around(0.05f), r = random.range(0.072f, 0.087f);
      builder.rod(Mat::bark, {x, y, -0.3f + shift}, {x, y, 0.3f + shift}, r, 6);
    }
  }
  for (float x : {-1.24f, 1.24f}) builder.stand(Mat::timber, {x, -0.2f, 0}, {0.08f, 1.35f, 0.5f});
}

void add_laundry(MeshBuilder& builder, Detail detail) {
  Random random(53);
  for (float x : {-3.0f, 3.0f}) {
    builder.stand(Mat::timber, {x, -0.5f, 0}, {0.1f, 2.75f, 0.1f});
    builder.box(Mat::timber, {x - 0.04f, 2.05f, -0.4f}, {x + 0.04f, 2.13f, 0.4f});
  }
  const auto sag = [](float x) { return 2.12f - 0.22f * (1 - x * x / 9); };
  for (float z : {-0.33f, 0.33f}) {
    const int spans = detail == Detail::low ? 2 : 10;
    for (int i = 0; i < spans; ++i) {
      const float a = -3 + 6 * static_cast<float>(i) / static_cast<float>(spans),
                  b = -3 + 6 * static_cast<float>(i + 1) / static_cast<float>(spans);
      builder.beam(Mat::straw, {a, sag(a), z}, {b, sag(b), z}, 0.012f, 0.012f, {0, 0, 1});
    }
    const std::array cloths{Mat::cloth_white, Mat::cloth_blue, Mat::cloth_white, Mat::cloth_red};
    float x = -2.7f;
    for (int i = 0; x < 1.9f; ++i) {
      const float width = random.range(0.5f, 1.15f), drop = random.range(0.7f, 1.35f);
      const Mat mat = cloths[random.index(4)];
      const int folds = detail == Detail::low ? 1 : 7, rows = detail == Detail::low ? 1 : 4;
      const auto point = [&](int u, int v) {
        const float s = static_cast<float>(u) / static_cast<float>(folds),
                    t = static_cast<float>(v) / static_cast<float>(rows);
        const float at = x + width * s;
        return vec3{at, sag(at) - drop * t, z + 0.07f * t * std::sin(s * 11 + static_cast<float>(i)) + 0.05f * t * t};
      };
      for (int u = 0; u < folds; ++u) {
        for (int v = 0; v < rows; ++v)
          builder.quad(mat, point(u, v + 1), point(u + 1, v + 1), point(u + 1, v), point(u, v));
      }
      x += width + random.range(0.1f, 0.4f);
    }
  }
}

void add_picket_fence(MeshBuilder& builder, Detail detail) {
  const float half = fence_m / 2;
  if (detail == Detail::low) {
    builder.box(Mat::paint_white, {-half, 0, -0.01f}, {half, 1, 0.03f});
    return;
  }
  for (float y : {0.3f, 0.78f}) builder.box(Mat::paint_white, {-half, y, -0.03f}, {half, y + 0.08f, 0.01f});
  builder.stand(Mat::paint_white, {-half, -0.5f, -0.02f}, {0.1f, 1.6f, 0.1f});
  const int count = 13;
  for (int i = 0; i < count; ++i) {
    const float x = -half + fence_m * (static_cast<float>(i) + 0.5f) / count, w = 0.045f, z = 0.012f, top = 0.98f;
    builder.box(Mat::paint_white, {x - w, -0.05f, z}, {x + w, top, z + 0.024f}, MeshBuilder::Ends::not_y);
    builder.triangle(Mat::paint_white, {x - w, top, z + 0.024f}, {x + w, top, z + 0.024f},
                     {x, top + 0.09f, z + 0.024f});
    builder.triangle(Mat::paint_white, {x + w, top, z}, {x - w, top, z}, {x, top + 0.09f, z});
  }
}

void add_stone_wall(MeshBuilder& builder, Detail detail) {
  const float half = fence_m / 2;
  builder.box(Mat::stone, {-half, -0.8f, -0.17f}, {half, 1.0f, 0.17f});
  if (detail == Detail::low) {
    builder.box(Mat::trim, {-half, 1.0f, -0.23f}, {half, 1.12f, 0.23f});
    return;
  }
  Random random(59);
  for (int side = 0; side < 2; ++side) {
    const auto scope = builder.at({}, 3.1415927f * static_cast<float>(side));
    for (int row = 0; row < 3; ++row) {
      float x = -half;
      while (x < half - 0.05f) {
        const float w = std::min(random.range(0.4f, 0.75f), half - x), y = 0.33f * static_cast<float>(row),
                    out = 0.19f + random.range(0.0f, 0.04f);
        builder.bar(Mat::trim, {x + 0.012f, y + 0.012f, 0.17f}, {x + w - 0.012f, y + 0.318f, out});
        x += w;
      }
    }
  }
  for (int i = 0; i < 6; ++i) {
    const float x = -half + 0.4f * static_cast<float>(i);
    builder.box(Mat::trim, {x + 0.01f, 1.0f, -0.24f}, {x + 0.39f, 1.12f + random.around(0.015f), 0.24f});
  }
}

void add_flower_bed(MeshBuilder& builder, Detail detail) {
  for (float z : {-0.6f, 0.52f}) builder.box(Mat::trim, {-1.4f, -0.2f, z}, {1.4f, 0.16f, z + 0.08f});
  for (float x : {-1.4f, 1.32f}) builder.box(Mat::trim, {x, -0.2f, -0.52f}, {x + 0.08f, 0.16f, 0.52f});
  builder.quad(Mat::earth, {-1.32f, 0.1f, 0.52f}, {1.32f, 0.1f, 0.52f}, {1.32f, 0.1f, -0.52f}, {-1.32f, 0.1f, -0.52f});
  Random random(61);
  add_flowers(builder, {0, 0.26f, 0}, {1.25f, 0.14f, 0.45f}, detail == Detail::low ? 12 : 130, random);
}

void add_gravestone(MeshBuilder& builder, Detail detail) {
  builder.box(Mat::trim, {-0.38f, -0.3f, -0.1f}, {0.38f, 0.85f, 0.06f});
  if (detail == Detail::low) return;
  const auto scope = builder.frame(glm::mat4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0.85f, -0.1f, 1));
  builder.lathe(Mat::trim, {{0, 0}, {0.38f, 0}, {0.38f, 0.16f}, {0, 0.16f}}, 16);
  builder.box(Mat::trim, {-0.5f, -0.2f, 0.75f}, {0.5f, 1.9f, 0.95f});
}

}  // namespace app
