// Models of the country: a windmill, bales, a jetty with its boats, reeds.
#include "scenes/country.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/random.hpp"

namespace app {
namespace {

using glm::vec3;

/// One sail along +y in the plane z = 0: a stock, a frame of laths, cloth over one side.
void add_sail(MeshBuilder& builder, Detail detail) {
  constexpr float length = 8.2f, width = 1.7f, first = 1.2f;
  builder.beam(Mat::timber, {0, 0, 0}, {0, length, 0}, 0.22f, 0.16f);
  builder.quad(Mat::cloth_white, {0.15f, first, 0.03f}, {width, first, -0.12f}, {width, length, -0.05f},
               {0.15f, length, 0.03f});
  if (detail == Detail::low) return;
  for (float y = first; y < length + 0.1f; y += 0.875f)
    builder.beam(Mat::timber, {-0.1f, y, 0.06f}, {width + 0.05f, y, -0.06f}, 0.05f, 0.05f, {0, 1, 0});
  builder.beam(Mat::timber, {width, first, -0.06f}, {width, length, -0.01f}, 0.06f, 0.06f);
}

}  // namespace

void add_windmill(MeshBuilder& builder, Detail detail) {
  const int sides = detail == Detail::low ? 8 : 20;
  builder.lathe(Mat::stone, {{3.9f, -2.5f}, {3.7f, 2.6f}}, sides);
  builder.lathe(Mat::plaster_white, {{3.62f, 2.6f}, {2.5f, 12}}, sides);
  builder.lathe(Mat::timber, {{3.7f, 2.6f}, {4.9f, 2.65f}, {4.9f, 2.8f}, {3.58f, 2.85f}}, sides);
  builder.lathe(Mat::roof_brown, {{2.5f, 11.95f}, {2.85f, 12}, {2.5f, 13.2f}, {1.4f, 14.5f}, {0, 15}}, sides);
  if (detail == Detail::full) {
    for (int i = 0; i < 20; ++i) {
      const float angle = 0.3141593f * static_cast<float>(i);
      builder.stand(Mat::timber, {4.8f * std::sin(angle), 2.8f, 4.8f * std::cos(angle)}, {0.08f, 0.95f, 0.08f});
    }
    builder.lathe(Mat::timber, {{4.72f, 3.7f}, {4.88f, 3.7f}, {4.88f, 3.8f}, {4.72f, 3.8f}, {4.72f, 3.7f}}, sides);
  }
  for (float y : {5.2f, 8.4f}) {
    const float out = 3.62f - 1.12f * (y - 2.6f) / 9.4f;
    builder.box(Mat::trim, {-0.6f, y - 0.1f, out - 0.6f}, {0.6f, y + 1.5f, out + 0.06f});
    builder.picture(y < 6 ? Mat::window_bright : Mat::window_warm, {-0.42f, y, out + 0.07f}, {0.42f, y, out + 0.07f},
                    {0.42f, y + 1.3f, out + 0.07f}, {-0.42f, y + 1.3f, out + 0.07f});
  }
  builder.box(Mat::paint_red, {-0.7f, 0, 3.2f}, {0.7f, 2.3f, 3.85f});
  builder.rod(Mat::timber, {0, 12.6f, 1.5f}, {0, 12.9f, 4.1f}, 0.22f, 6);
  for (int i = 0; i < 4; ++i) {
    const float angle = 0.42f + 1.5707963f * static_cast<float>(i), c = std::cos(angle), s = std::sin(angle);
    const auto scope = builder.frame(glm::mat4(c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 12.85f, 3.9f, 1));
    add_sail(builder, detail);
  }
}

void add_hay_bale(MeshBuilder& builder, Detail detail) {
  // The lathe's axis along x.
  const auto scope = builder.frame(glm::mat4(0, 1, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, -0.65f, 0.7f, 0, 1));
  builder.lathe(Mat::straw, {{0, 0}, {0.6f, 0}, {0.75f, 0.06f}, {0.75f, 1.24f}, {0.6f, 1.3f}, {0, 1.3f}},
                detail == Detail::low ? 7 : 18);
}

void add_reeds(MeshBuilder& builder, Detail detail) {
  Random random(163);
  const int count = detail == Detail::low ? 14 : 90;
  for (int i = 0; i < count; ++i) {
    const vec3 foot{random.around(1.6f), -0.5f, random.around(1.0f)};
    const float tall = random.range(1.3f, 2.5f), turn = random.range(0, 6.2831853f);
    const vec3 along{random.around(0.35f), tall, random.around(0.35f)}, across{std::cos(turn), 0, std::sin(turn)};
    builder.leaf(i % 3 ? Mat::leaf_olive : Mat::straw, foot, along, across * (detail == Detail::low ? 0.12f : 0.035f),
                 glm::normalize(glm::cross(along, across)));
  }
}

void add_jetty(MeshBuilder& builder, Detail detail) {
  const int posts = 9;
  for (int i = 0; i < posts; ++i) {
    const float z = 0.6f + (jetty_m - 1) * static_cast<float>(i) / (posts - 1);
    for (float x : {-jetty_half_m + 0.1f, jetty_half_m - 0.1f})
      builder.rod(Mat::timber, {x, -4.5f, z}, {x, i % 2 ? 0.75f : -0.1f, z}, 0.12f, detail == Detail::low ? 4 : 7);
    builder.box(Mat::timber, {-jetty_half_m, -0.26f, z - 0.08f}, {jetty_half_m, -0.06f, z + 0.08f});
  }
  const int planks = detail == Detail::low ? 1 : 88;
  const float step = jetty_m / static_cast<float>(planks);
  Random random(167);
  for (int i = 0; i < planks; ++i) {
    const float z = step * static_cast<float>(i), end = jetty_half_m + random.around(0.06f);
    builder.box(Mat::plank, {-end, -0.06f, z}, {end, random.around(0.008f), z + step - 0.02f});
  }
}

void add_boat(MeshBuilder& builder, Detail detail) {
  const int stations = detail == Detail::low ? 7 : 11;
  struct Rib {
    vec3 keel, bilge, rail;
  };
  // Of the outside, or `in` metres further in.
  const auto rib = [&](int i, float side, float in) {
    const float t = 2 * static_cast<float>(i) / static_cast<float>(stations - 1) - 1;  // -1 stern, 1 bow.
    const float wide = std::max(0.72f * (t < 0 ? 1 - 0.25f * t * t : 1 - t * t * t) - in, 0.02f - in / 4);
    const float rise = std::max(0.0f, t * t * t);
    return Rib{{0, -0.16f + 0.2f * rise + in, 2.1f * t},
               {side * wide * 0.72f, -0.1f + 0.1f * rise + in, 2.12f * t},
               {side * wide, 0.42f + 0.22f * t * t, 2.15f * t}};
  };
  constexpr float thick = 0.04f;
  for (float side : {-1.0f, 1.0f}) {
    // Counter-clockwise seen from where x is larger.
    const auto face = [&](Mat mat, bool towards_larger_x, vec3 a, vec3 b, vec3 c, vec3 d) {
      towards_larger_x ? builder.quad(mat, a, b, c, d) : builder.quad(mat, c, b, a, d);
    };
    for (int i = 0; i + 1 < stations; ++i) {
      for (bool is_outside : {true, false}) {
        const float in = is_outside ? 0 : thick;
        const Rib a = rib(i, side, in), b = rib(i + 1, side, in);
        const Mat mat = is_outside ? Mat::paint_blue : Mat::plank;
        const bool larger_x = (side > 0) == is_outside;
        face(mat, larger_x, a.bilge, a.rail, b.rail, b.bilge);
        face(mat, larger_x, a.keel, a.bilge, b.bilge, b.keel);
      }
      builder.beam(Mat::paint_white, rib(i, side, thick / 2).rail, rib(i + 1, side, thick / 2).rail, 0.07f, 0.05f);
    }
  }
  const Rib left = rib(0, -1, 0), right = rib(0, 1, 0), left_in = rib(0, -1, thick), right_in = rib(0, 1, thick);
  builder.quad(Mat::paint_blue, right.bilge, left.bilge, left.rail, right.rail);
  const auto stern = builder.at({0, 0, thick});
  builder.quad(Mat::plank, left_in.bilge, right_in.bilge, right_in.rail, left_in.rail);
  for (float z : {-1.3f, 0.1f, 1.1f}) builder.box(Mat::plank, {-0.6f, 0.22f, z}, {0.6f, 0.26f, z + 0.26f});
}

void add_floodlight(MeshBuilder& builder, Detail detail) {
  builder.lathe(Mat::trim, {{0.55f, -0.5f}, {0.55f, 0.05f}, {0.42f, 0.05f}, {0.42f, -0.02f}},
                detail == Detail::low ? 6 : 14);
  builder.lathe(Mat::glow, {{0.42f, -0.02f}, {0, 0}}, detail == Detail::low ? 6 : 14);
}

}  // namespace app
