// Lanterns open below and at the sides: light leaves downwards freely, four thin bars and a cap give it shape.
#include <cmath>

#include "scenes/props.hpp"

namespace app {
namespace {

using glm::vec3;

/// Around the light at the current origin. Nothing is nearer than 0.1 m, outside the light's near cube.
void add_lantern(MeshBuilder& builder, Detail detail) {
  if (detail == Detail::low) {
    builder.lathe(Mat::glow, {{0, 0.11f}, {0.105f, 0.2f}, {0.04f, 0.29f}}, 4);
    builder.lathe(Mat::iron, {{0, 0.28f}, {0.26f, 0.29f}, {0, 0.5f}}, 4);
    return;
  }
  constexpr int sides = 7;
  builder.lathe(Mat::glow, {{0, 0.11f}, {0.085f, 0.13f}, {0.105f, 0.19f}, {0.085f, 0.27f}, {0.04f, 0.29f}}, sides);
  builder.lathe(Mat::iron, {{0.27f, 0.27f}, {0.29f, 0.29f}, {0.12f, 0.40f}, {0.03f, 0.44f}, {0.03f, 0.51f}}, sides);
  builder.lathe(Mat::iron, {{0, 0.285f}, {0.27f, 0.27f}}, sides);
  // Three thin bars bulge around the light and meet in a knob below it.
  const vec3 knob{0, -0.3f, 0};
  for (int i = 0; i < 3; ++i) {
    const float angle = 2.0943951f * static_cast<float>(i);
    const vec3 out{std::sin(angle), 0, std::cos(angle)};
    const vec3 bulge = 0.18f * out + vec3(0, -0.13f, 0);
    builder.beam(Mat::iron, knob, bulge, 0.007f, 0.007f);
    builder.beam(Mat::iron, bulge, 0.2f * out + vec3(0, 0.285f, 0), 0.007f, 0.007f);
  }
  builder.ball(Mat::iron, knob, 0.018f, 5);
}

/// An arm from the origin to `end`, with a scroll under it.
void add_bracket(MeshBuilder& builder, vec3 end, Detail detail) {
  builder.beam(Mat::iron, {0, end.y, 0}, {0, end.y, end.z + 0.1f}, 0.035f, 0.035f);
  if (detail == Detail::low) return;
  std::vector<vec3> curve;
  std::vector<float> radii;
  for (int i = 0; i <= 7; ++i) {
    const float t = static_cast<float>(i) / 7;
    curve.push_back({0, end.y - 0.5f * (1 - t) * (1 - t), end.z * (0.02f + 0.75f * t)});
    radii.push_back(0.014f);
  }
  builder.tube(Mat::iron, curve, radii, 4);
}

}  // namespace

void add_street_lamp(MeshBuilder& builder, Detail detail) {
  if (detail == Detail::low)
    builder.lathe(Mat::iron, {{0.12f, -0.6f}, {0.055f, 4.2f}}, 4);
  else
    builder.lathe(Mat::iron,
                  {{0.2f, -0.6f},
                   {0.2f, 0.12f},
                   {0.13f, 0.2f},
                   {0.13f, 0.6f},
                   {0.07f, 0.78f},
                   {0.055f, 3.7f},
                   {0.09f, 3.76f},
                   {0.05f, 3.86f},
                   {0.05f, 4.1f},
                   {0, 4.3f}},
                  8);
  const vec3 hook = street_lamp_light + vec3(0, 0.62f, 0);
  add_bracket(builder, hook, detail);
  builder.beam(Mat::iron, street_lamp_light + vec3(0, 0.5f, 0), hook, 0.02f, 0.02f);
  const auto scope = builder.at(street_lamp_light);
  add_lantern(builder, detail);
}

void add_wall_lamp(MeshBuilder& builder, Detail detail) {
  const vec3 hook = wall_lamp_light + vec3(0, 0.6f, 0);
  builder.box(Mat::iron, {-0.06f, -0.05f, -0.03f}, {0.06f, 0.7f, 0.03f});
  add_bracket(builder, hook, detail);
  builder.beam(Mat::iron, wall_lamp_light + vec3(0, 0.5f, 0), hook, 0.02f, 0.02f);
  const auto scope = builder.at(wall_lamp_light);
  add_lantern(builder, detail);
}

void add_yard_lamp(MeshBuilder& builder, Detail detail) {
  // A wooden post beside the light, with an arm over it.
  const float arm = yard_lamp_light.y + 0.55f;
  builder.box(Mat::timber, {-0.07f, -0.6f, -0.52f}, {0.07f, arm + 0.15f, -0.38f});
  builder.box(Mat::timber, {-0.05f, arm - 0.05f, -0.6f}, {0.05f, arm + 0.05f, 0.12f});
  builder.beam(Mat::timber, {0, arm - 0.45f, -0.4f}, {0, arm - 0.03f, -0.05f}, 0.06f, 0.06f);
  builder.beam(Mat::iron, yard_lamp_light + vec3(0, 0.49f, 0), {0, arm, 0}, 0.02f, 0.02f);
  const auto scope = builder.at(yard_lamp_light);
  add_lantern(builder, detail);
}

}  // namespace app
