// Reference of caster culling: which batches a light's views must be given.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/box.hpp"
#include "reference/light.hpp"

namespace reference {

/// Cube faces in Vulkan's order: +X, −X, +Y, −Y, +Z, −Z, as bits 0…5 of a mask.
constexpr uint32_t cube_faces = 6;

/// Faces of the world-aligned cube around `center` beyond whose near plane the box meets the face's pyramid. Exact: a
/// point with the largest coordinate along the face's axis and the smallest across decides for the whole box.
uint32_t cube_face_mask(glm::vec3 center, float near, const Box& box);

/// The same for one view given as planes (inside: dot(plane.xyz, p) + plane.w ≥ 0): false only where one plane has
/// all of the box outside.
bool planes_may_meet(std::span<const glm::vec4> planes, const Box& box);

struct Caster {
  uint32_t batch = 0;
  uint32_t views = 0;  ///< Cube faces as above; 1 for lights with one view.
  friend bool operator==(const Caster&, const Caster&) = default;
};

/// Batches, ascending, whose boxes meet the light's range, with the views they must be drawn to: cubes by
/// cube_face_mask, one view by view_planes, everything where there are none. Batches without a view are left out.
std::vector<Caster> list_casters(const Light&, std::span<const glm::vec4> view_planes, std::span<const Box> batches);

}  // namespace reference
