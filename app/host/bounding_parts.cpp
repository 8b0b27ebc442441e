// The box with the largest surface is halved, again and again.
#include "host/bounding_parts.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace app {

namespace {

constexpr MeshBox kEmpty{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};

void include(MeshBox& box, const glm::vec3& point) {
  box.lowest = glm::min(box.lowest, point);
  box.highest = glm::max(box.highest, point);
}

/// Triangles by number, which the parts share out among them.
struct Part {
  std::span<uint32_t> triangles;
  MeshBox box;

  float surface() const {
    const glm::vec3 size = box.highest - box.lowest;
    return triangles.size() > 1 ? size.x * size.y + size.y * size.z + size.z * size.x : -1.0f;
  }
};

class Splitter {
 public:
  explicit Splitter(const Primitive& primitive) : primitive_(primitive) {}

  Part part_of(std::span<uint32_t> triangles) const {
    Part part{triangles, kEmpty};
    for (const uint32_t triangle : triangles)
      for (int i = 0; i < 3; ++i) include(part.box, corner(triangle, i));
    return part;
  }

  /// Moves the triangles beyond the middle of the part, along where their centres lie farthest apart, into a part of their own.
  Part split(Part& part) const {
    MeshBox centers = kEmpty;
    for (const uint32_t triangle : part.triangles) include(centers, center(triangle));
    const glm::vec3 size = centers.highest - centers.lowest;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const float middle = 0.5f * (centers.lowest[axis] + centers.highest[axis]);
    const auto beyond = std::partition(part.triangles.begin(), part.triangles.end(),
                                       [&](uint32_t triangle) { return center(triangle)[axis] < middle; });
    auto kept = static_cast<size_t>(beyond - part.triangles.begin());
    if (kept == 0 || kept == part.triangles.size()) kept = part.triangles.size() / 2;  // all centres in one place
    Part rest = part_of(part.triangles.subspan(kept));
    part = part_of(part.triangles.first(kept));
    return rest;
  }

 private:
  const glm::vec3& corner(uint32_t triangle, int i) const {
    return primitive_.positions[primitive_.indices[3 * triangle + static_cast<uint32_t>(i)]];
  }
  glm::vec3 center(uint32_t triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3.0f;
  }
  const Primitive& primitive_;
};

}  // namespace

std::vector<MeshBox> bounding_parts(const Primitive& primitive, size_t most) {
  std::vector<uint32_t> triangles(primitive.indices.size() / 3);
  if (triangles.empty() || most == 0) return {};
  std::iota(triangles.begin(), triangles.end(), 0u);
  const Splitter splitter(primitive);
  std::vector<Part> parts{splitter.part_of(triangles)};
  while (parts.size() < most) {
    const auto largest = std::max_element(parts.begin(), parts.end(),
                                          [](const Part& a, const Part& b) { return a.surface() < b.surface(); });
    if (largest->triangles.size() < 2) break;
    const Part rest = splitter.split(*largest);
    parts.push_back(rest);
  }
  std::vector<MeshBox> boxes;
  for (const Part& part : parts) boxes.push_back(part.box);
  return boxes;
}

}  // namespace app
