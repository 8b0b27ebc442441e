#include "commands/error_shapes.hpp"

#include <cassert>
#include <vector>

namespace app {
namespace {

constexpr float alike_cosine = 0.98f;
constexpr int acne_radius = 2;
constexpr uint32_t acne_least_pixels = 8;
constexpr uint32_t acne_share = 5;  // one in …
constexpr int leak_side = 4;

class Shapes {
 public:
  Shapes(const reference::SurfaceImage& image, std::span<const uint8_t> errors) : image_(image), errors_(errors) {}

  bool is_acne(int x, int y) const {
    uint32_t wrong = 0, right = 0;
    for (int dy = -acne_radius; dy <= acne_radius; ++dy) {
      for (int dx = -acne_radius; dx <= acne_radius; ++dx) {
        if (!alike(x, y, x + dx, y + dy)) continue;
        ++(kind(x + dx, y + dy) == ErrorKind::false_dark ? wrong : right);
      }
    }
    const uint32_t all = wrong + right;
    return all >= acne_least_pixels && wrong * acne_share >= all && right * acne_share >= all;
  }

  /// Counts the patch that (x, y) belongs to unless it was counted before.
  void count_patch(int x, int y, std::vector<uint8_t>& seen, ErrorShapes& shapes) const {
    if (seen[index(x, y)]) return;
    seen[index(x, y)] = 1;
    std::vector<glm::ivec2> patch{{x, y}};
    bool thick = false, at_contact = false;
    for (size_t next = 0; next < patch.size(); ++next) {
      const glm::ivec2 p = patch[next];
      thick = thick || starts_square(p.x, p.y);
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int nx = p.x + dx, ny = p.y + dy;
          at_contact = at_contact || (inside(nx, ny) && !alike(p.x, p.y, nx, ny));
          if (kind(nx, ny) != ErrorKind::false_lit || seen[index(nx, ny)]) continue;
          seen[index(nx, ny)] = 1;
          patch.emplace_back(nx, ny);
        }
      }
    }
    if (thick) {
      shapes.leak += patch.size();
    } else if (at_contact) {
      shapes.detached += patch.size();
    }
  }

  ErrorKind kind(int x, int y) const {
    return inside(x, y) ? ErrorKind(errors_[index(x, y)]) : ErrorKind::not_evaluated;
  }

 private:
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < int(image_.width) && y < int(image_.height); }
  size_t index(int x, int y) const { return size_t(y) * image_.width + size_t(x); }

  glm::vec3 normal(int x, int y) const {
    const float* n = &image_.normals[3 * index(x, y)];
    return {n[0], n[1], n[2]};
  }

  bool alike(int x, int y, int other_x, int other_y) const {
    return kind(other_x, other_y) != ErrorKind::not_evaluated &&
           glm::dot(normal(x, y), normal(other_x, other_y)) >= alike_cosine;
  }

  bool starts_square(int x, int y) const {
    for (int dy = 0; dy < leak_side; ++dy) {
      for (int dx = 0; dx < leak_side; ++dx) {
        if (kind(x + dx, y + dy) != ErrorKind::false_lit) return false;
      }
    }
    return true;
  }

  const reference::SurfaceImage& image_;
  std::span<const uint8_t> errors_;
};

}  // namespace

ErrorShapes find_error_shapes(const reference::SurfaceImage& image, std::span<const uint8_t> errors) {
  assert(errors.size() == size_t(image.width) * image.height);
  const Shapes pixels(image, errors);
  ErrorShapes shapes;
  std::vector<uint8_t> seen(errors.size());
  for (int y = 0; y < int(image.height); ++y) {
    for (int x = 0; x < int(image.width); ++x) {
      const ErrorKind kind = pixels.kind(x, y);
      if (kind == ErrorKind::false_dark) shapes.acne += pixels.is_acne(x, y);
      if (kind == ErrorKind::false_lit) pixels.count_patch(x, y, seen, shapes);
    }
  }
  return shapes;
}

}  // namespace app
