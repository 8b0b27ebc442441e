// The stub host's scene: a floor, a table, pillars, under lights of every type.
#include <array>
#include <stdexcept>

#include "stub_host.hpp"

namespace embedding {

namespace {

constexpr std::array<uint32_t, 36> box_indices{0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6, 0, 4, 5, 0, 5, 1,
                                               1, 5, 6, 1, 6, 2, 2, 6, 7, 2, 7, 3, 3, 7, 4, 3, 4, 0};

/// Corners of a box of half extent 1, x scaled by `x_sign`.
std::array<umbrage::Vec3, 8> box_positions(float x_sign) {
  return {{{-x_sign, -1, -1},
           {x_sign, -1, -1},
           {x_sign, 1, -1},
           {-x_sign, 1, -1},
           {-x_sign, -1, 1},
           {x_sign, -1, 1},
           {x_sign, 1, 1},
           {-x_sign, 1, 1}}};
}

umbrage::Vec3 vec3(glm::vec3 v) { return {v.x, v.y, v.z}; }

template <class Edit>
auto attempt(const Edit& edit, const std::function<bool(const umbrage::Error&)>& again) {
  auto result = edit();
  if (!result && again && again(result.error())) result = edit();
  if (!result) throw std::runtime_error(result.error().message);
  return *result;
}

}  // namespace

Scene Scene::room(glm::vec3 offset) {
  Scene scene;
  scene.boxes = {{{0, -0.5f, 0}, {8, 0.5f, 6}},
                 {{0, 1.2f, 0}, {1.5f, 0.1f, 1}},
                 {{-1.2f, 0.55f, 0}, {0.1f, 0.55f, 0.1f}},
                 {{1.2f, 0.55f, 0}, {0.1f, 0.55f, 0.1f}},
                 {{-4, 1.5f, -2}, {0.4f, 1.5f, 0.4f}},
                 {{4, 1.5f, 2}, {0.4f, 1.5f, 0.4f}}};
  const glm::vec3 points[] = {{3, 3, 1}, {-3, 2.5f, 2}, {0, 4, -3}, {-5, 1, 0}};
  for (const glm::vec3& point : points) scene.lights.push_back({.position = vec3(point), .range_m = 9});
  scene.lights.push_back({.type = umbrage::LightType::spot,
                          .position = {0, 5, 3},
                          .direction = {0, -1, -0.6f},
                          .range_m = 12,
                          .inner_cone_rad = 0.4f,
                          .outer_cone_rad = 0.7f});
  for (uint32_t i = 0; i < scene.lights.size(); i++) {
    auto& light = scene.lights[i];
    light.host_index = i;
    light.position = {light.position.x + offset.x, light.position.y + offset.y, light.position.z + offset.z};
  }
  for (Box& box : scene.boxes) box.center_ws += offset;
  return scene;
}

Convention Convention::in_room() {
  Convention convention;
  convention.view_from_world[3] = glm::vec4(0, -2, -9, 1);
  convention.clip_from_view = glm::mat4(0);
  convention.clip_from_view[0][0] = 0.8f;
  convention.clip_from_view[1][1] = -1.2f;
  convention.clip_from_view[3][2] = 0.1f;
  convention.clip_from_view[2][3] = -1;
  return convention;
}

void Scene::add_to(umbrage::ShadowSystem& system, const std::function<bool(const umbrage::Error&)>& again) const {
  const float x_sign = mirrored ? -1.0f : 1.0f;
  const auto positions = box_positions(x_sign);
  const auto mesh = attempt([&] { return system.add_mesh({.positions = positions, .indices = box_indices}); }, again);
  for (const Box& box : boxes) {
    const glm::vec3 scale = box.half_extent * glm::vec3(x_sign, 1, 1), at = box.center_ws;
    const umbrage::Affine place{{scale.x, 0, 0, at.x, 0, scale.y, 0, at.y, 0, 0, scale.z, at.z}};
    attempt([&] { return system.add_instance({.mesh = mesh, .world_from_mesh = place}); }, again);
  }
  for (const auto& light : lights) attempt([&] { return system.add_light(light); }, again);
}

}  // namespace embedding
