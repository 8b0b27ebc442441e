#include "reference/hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace reference {
namespace {

uint32_t spread_bits(uint32_t value) {
  uint32_t result = 0;
  for (uint32_t bit = 0; bit < 10; ++bit) result |= (value >> bit & 1u) << (3 * bit);
  return result;
}

void visit(const Hierarchy& tree, size_t level, size_t node, glm::vec3 center, float radius,
           std::vector<uint32_t>& leaves) {
  if (squared_distance(tree.levels[level][node], center) > radius * radius) return;
  if (level == 0) {
    leaves.push_back(tree.order[node]);
    return;
  }
  const size_t end = std::min((node + 1) * children_per_node, tree.levels[level - 1].size());
  for (size_t child = node * children_per_node; child < end; ++child) {
    visit(tree, level - 1, child, center, radius, leaves);
  }
}

}  // namespace

uint32_t morton_code(const Box& scene_box, glm::vec3 position) {
  uint32_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = scene_box.max[axis] - scene_box.min[axis];
    const float t = extent > 0 ? (position[axis] - scene_box.min[axis]) / extent : 0;
    code |= spread_bits(uint32_t(std::clamp(std::floor(1024 * t), 0.0f, 1023.0f))) << axis;
  }
  return code;
}

std::vector<uint32_t> morton_order(std::span<const Box> boxes) {
  Box all;
  for (const Box& box : boxes) all.grow(box);
  std::vector<uint32_t> codes(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) codes[i] = morton_code(all, boxes[i].center());
  std::vector<uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return codes[a] < codes[b]; });
  return order;
}

Hierarchy build_hierarchy(std::span<const Box> boxes) {
  Hierarchy tree{morton_order(boxes), {}};
  if (boxes.empty()) return tree;
  std::vector<Box>& leaves = tree.levels.emplace_back();
  for (const uint32_t index : tree.order) leaves.push_back(boxes[index]);
  while (tree.levels.back().size() > 1) {
    const std::vector<Box>& below = tree.levels.back();
    std::vector<Box> nodes((below.size() + children_per_node - 1) / children_per_node);
    for (size_t i = 0; i < below.size(); ++i) nodes[i / children_per_node].grow(below[i]);
    tree.levels.push_back(std::move(nodes));
  }
  return tree;
}

std::vector<uint32_t> leaves_meeting_sphere(const Hierarchy& tree, glm::vec3 center, float radius) {
  std::vector<uint32_t> leaves;
  if (!tree.levels.empty()) visit(tree, tree.levels.size() - 1, 0, center, radius, leaves);
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

}  // namespace reference
