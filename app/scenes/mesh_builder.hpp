// Solid shapes into triangles by material: outward counter-clockwise faces, unit normals, texture coordinates in
// metres.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "scenes/materials.hpp"

namespace app {

/// How finely the town's models are made.
enum class Detail : uint8_t { full, low };

/// A point of a lathe's outline: distance from the axis, height.
struct RadiusHeight {
  float radius, height;
};

/// Shapes are given in the current frame (Frame below), in metres. Triangles without area are left out.
class MeshBuilder {
 public:
  using vec2 = glm::vec2;
  using vec3 = glm::vec3;

  /// While it lives, shapes are moved by `local` within the frame outside: rotations, translations, uniform scales > 0.
  class [[nodiscard]] Frame {
   public:
    Frame(MeshBuilder& builder, const glm::mat4& local);
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;
    ~Frame();

   private:
    MeshBuilder& builder_;
    glm::mat4 outer_;
  };
  Frame frame(const glm::mat4& local) { return Frame(*this, local); }
  Frame at(vec3 position, float turn_y = 0);

  /// Flat; a, b, c counter-clockwise seen from outside.
  void triangle(Mat mat, vec3 a, vec3 b, vec3 c);
  void quad(Mat mat, vec3 a, vec3 b, vec3 c, vec3 d);
  /// Texture coordinates (0,1), (1,1), (1,0), (0,0) at a, b, c, d: a picture upright when a is its lower left.
  void picture(Mat mat, vec3 a, vec3 b, vec3 c, vec3 d);
  /// Corners: four counter-clockwise seen from above, then the four above them.
  void block(Mat mat, const std::array<vec3, 8>& corners);
  /// Which ends of a bar show.
  enum class Ends : uint8_t { all, not_x, not_y };
  void box(Mat mat, vec3 low, vec3 high, Ends ends = Ends::all);
  /// A box on a wall: without its back (-z).
  void bar(Mat mat, vec3 low, vec3 high, Ends ends = Ends::all);
  /// As quad, with the texture moved: for things of which each has its own stain.
  void stained_quad(Mat mat, vec3 a, vec3 b, vec3 c, vec3 d, vec2 uv_shift);
  /// An upright box of this size that stands on `foot` (its bottom's centre).
  void stand(Mat mat, vec3 foot, vec3 size);
  /// A straight bar from `from` to `to`; width along `side` made perpendicular, depth across both.
  void beam(Mat mat, vec3 from, vec3 to, float width, float depth, vec3 side = {1, 0, 0});
  /// Round bar along points with a radius at each; smooth; open ends are capped where the radius is not 0.
  void tube(Mat mat, std::span<const vec3> points, std::span<const float> radii, int sides);
  void rod(Mat mat, vec3 from, vec3 to, float radius, int sides);
  /// Turned around the y axis; the outline runs from bottom to top with the solid on the axis' side. Smooth around,
  /// creased along.
  void lathe(Mat mat, std::span<const RadiusHeight> outline, int sides);
  void lathe(Mat mat, std::initializer_list<RadiusHeight> outline, int sides) {
    lathe(mat, std::span(outline.begin(), outline.size()), sides);
  }
  void ball(Mat mat, vec3 centre, float radius, int sides);
  /// A thin leaf: two triangles folded along `along`; both sides show with a double-sided material.
  void leaf(Mat mat, vec3 stem, vec3 along, vec3 across, vec3 normal);
  /// Triangles of a surface with its own normals; indices into these arrays. Texture coordinates: empty = metres.
  void surface(Mat mat, std::span<const vec3> positions, std::span<const vec3> normals, std::span<const vec2> uvs,
               std::span<const uint32_t> indices);

  size_t triangle_count() const;
  /// The mesh made so far, one primitive a material, in the order of Mat. The builder is empty afterwards.
  Mesh take(std::string name);

 private:
  struct Vertex {
    vec3 position, normal;
    vec2 uv;
  };
  uint32_t add_vertex(Primitive& primitive, const Vertex& vertex) const;
  void add_triangle(Mat mat, const Vertex& a, const Vertex& b, const Vertex& c);

  std::array<Primitive, static_cast<size_t>(Mat::count)> primitives_;
  glm::mat4 world_from_local_{1};
};

glm::mat4 place(glm::vec3 position, float turn_y);

}  // namespace app
