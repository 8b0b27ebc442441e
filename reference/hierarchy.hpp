// Reference of the bounding volume hierarchy: boxes sorted along the Morton curve under an implicit, left-balanced
// tree of 32 children a node, rebuilt each frame. Olsson et al. 2014, section 4.2.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/box.hpp"

namespace reference {

constexpr uint32_t children_per_node = 32;

/// 30-bit code of a position inside a box: ⌊1024 t⌋ clamped to 0…1023 on each axis (0 where the box is flat), bits
/// interleaved with x lowest, then y, then z.
uint32_t morton_code(const Box& scene_box, glm::vec3 position);

/// Indices of the boxes by the Morton code of their centres within the box of all boxes; ties keep their order.
std::vector<uint32_t> morton_order(std::span<const Box> boxes);

struct Hierarchy {
  std::vector<uint32_t> order;  ///< Of the leaves: leaf i is boxes[order[i]].
  /// levels[0]: the leaves' boxes in that order. Node i of a level holds nodes 32 i … 32 i + 31 of the one before, as
  /// many as there are; the last level has one node. No boxes: no levels.
  std::vector<std::vector<Box>> levels;
};

Hierarchy build_hierarchy(std::span<const Box> boxes);

/// Leaves, as indices into the boxes it was built of, whose boxes meet a sphere, through the tree; ascending.
std::vector<uint32_t> leaves_meeting_sphere(const Hierarchy&, glm::vec3 center, float radius);

}  // namespace reference
