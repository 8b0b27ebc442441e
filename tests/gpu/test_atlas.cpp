// Depth in the atlas against rays through the texels' centres, for every kind of light; both writers, and twice the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "system_rig.hpp"

namespace umbrage::test {
namespace {

class AtlasDepth : public GpuTest {};

using dvec3 = glm::dvec3;

struct Triangle {
  dvec3 a, ab, ac;
  std::array<glm::dvec2, 3> uv;
  bool masked;
};

/// World triangles of what casts for a light.
std::vector<Triangle> triangles_of(const TestScene& scene, uint32_t light_mask) {
  std::vector<Triangle> out;
  for (const TestInstance& instance : scene.instances) {
    if (!instance.casts || !(instance.light_mask & light_mask)) continue;
    const TestMesh& mesh = scene.meshes[instance.mesh];
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      std::array<dvec3, 3> p;
      Triangle triangle{.masked = !mesh.uvs.empty()};
      for (size_t k = 0; k < 3; ++k) {
        p[k] = dvec3(transform(instance.world_from_mesh, mesh.positions[mesh.indices[i + k]]));
        if (triangle.masked) triangle.uv[k] = {mesh.uvs[mesh.indices[i + k]].x, mesh.uvs[mesh.indices[i + k]].y};
      }
      triangle.a = p[0], triangle.ab = p[1] - p[0], triangle.ac = p[2] - p[0];
      out.push_back(triangle);
    }
  }
  return out;
}

enum class Alpha : uint8_t { solid, hole, unsure };

/// The rig's mask: checkers of a quarter of the side; near a border the filter decides.
Alpha mask_at(const glm::dvec2& uv) {
  const glm::dvec2 cell = uv * 4.0, border = glm::abs(cell - glm::round(cell));
  if (std::min(border.x, border.y) < 0.13) return Alpha::unsure;  // half a texel and a little
  return (int(std::floor(cell.x)) + int(std::floor(cell.y))) % 2 ? Alpha::solid : Alpha::hole;
}

struct RayHit {
  double distance = INFINITY;
  int triangle = -1;
  bool unsure = false;  // of a mask
};

/// Nearest hit at least `first` along a ray, in units of the direction.
RayHit trace(const std::vector<Triangle>& triangles, const dvec3& origin, const dvec3& direction, double first) {
  RayHit nearest;
  for (size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& triangle = triangles[i];
    const dvec3 p = glm::cross(direction, triangle.ac);
    const double determinant = glm::dot(triangle.ab, p);
    if (determinant == 0) continue;
    const dvec3 from = origin - triangle.a;
    const double u = glm::dot(from, p) / determinant;
    const dvec3 q = glm::cross(from, triangle.ab);
    const double v = glm::dot(direction, q) / determinant, distance = glm::dot(triangle.ac, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || distance < first || distance >= nearest.distance) continue;
    bool unsure = false;
    if (triangle.masked) {
      const Alpha alpha = mask_at(triangle.uv[0] * (1 - u - v) + triangle.uv[1] * u + triangle.uv[2] * v);
      if (alpha == Alpha::hole) continue;
      unsure = alpha == Alpha::unsure;
    }
    nearest = {distance, static_cast<int>(i), unsure};
  }
  return nearest;
}

/// A view's rays, from the light's description and not from what the device made of it (the ortho fit excepted).
struct Rays {
  std::function<dvec3(double s, double t)> origin, direction;
  std::function<double(double)> depth;  // what the atlas holds for a distance
  double first = 0;
};

Rays rays_of(const LightDesc& light, const shared::LightRecord& record, const shared::ShadowView& view, uint32_t face) {
  const dvec3 position(to_glm(light.position));
  const double near = light.near_m > 0 ? light.near_m : light.range_m / 256;
  Rays rays{
      .origin = [=](double, double) { return position; }, .depth = [=](double d) { return near / d; }, .first = near};
  if (record.views == shared::ViewsCube) {
    rays.direction = [=](double s, double t) {
      const dvec3 zero(shared::face_direction(face, 0, 0)), right(shared::face_direction(face, 1, 0)),
          down(shared::face_direction(face, 0, 1));
      return zero + (right - zero) * s + (down - zero) * t;
    };
  } else if (record.views == shared::ViewsSpot) {
    const glm::dmat3 rows(glm::transpose(shared::view_rotation(to_glm(light.direction))));
    const double tangent = std::tan(double(light.outer_cone_rad)) * record.resolution /
                           (record.resolution - 2.0 * shared::ViewGuardTexels);
    rays.direction = [=](double s, double t) { return rows[2] + rows[0] * (s * tangent) + rows[1] * (t * tangent); };
  } else {
    const double half_side = 0.5 * view.side_m;
    const dvec3 x(glm::normalize(dvec3(view.x_row))), y(glm::normalize(dvec3(view.y_row))), origin(view.origin),
        z_row(view.z_row);
    const dvec3 forward = glm::normalize(dvec3(to_glm(light.direction)));
    const double z_offset = view.z_offset;
    rays.origin = [=](double s, double t) { return origin + x * (s * half_side) + y * (t * half_side); };
    rays.direction = [=](double, double) { return forward; };
    rays.depth = [=](double d) { return glm::dot(z_row, forward) * d + z_offset; };
    rays.first = -INFINITY;
  }
  return rays;
}

struct Tally {
  uint64_t texels = 0, unsure = 0, drawn = 0;
};

/// Each texel around whose centre a hundredth of a texel sees one surface (or nothing) must hold its depth.
void expect_view(const Atlas& atlas, const shared::ShadowView& view, const Rays& rays,
                 const std::vector<Triangle>& triangles, const std::string& what, Tally& tally) {
  const uint32_t side = view.resolution;
  const glm::dvec2 offsets[] = {{0, 0}, {0.01, 0.01}, {-0.01, 0.01}, {0.01, -0.01}, {-0.01, -0.01}};
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      ++tally.texels;
      double expected = 0, spread = 0;
      int triangle = -1;
      bool unsure = false;
      for (const glm::dvec2& offset : offsets) {
        const double s = (x + 0.5 + offset.x) / side * 2 - 1, t = (y + 0.5 + offset.y) / side * 2 - 1;
        const RayHit hit = trace(triangles, rays.origin(s, t), rays.direction(s, t), rays.first);
        const double depth = hit.triangle < 0 ? 0 : rays.depth(hit.distance);
        if (&offset == offsets) expected = depth, triangle = hit.triangle;
        unsure = unsure || hit.unsure || (hit.triangle < 0) != (triangle < 0);
        spread = std::max(spread, std::abs(depth - expected));
      }
      unsure = unsure || spread > 0.01 * expected;  // a silhouette, or a surface seen edge-on
      if (unsure) {
        ++tally.unsure;
        continue;
      }
      tally.drawn += triangle >= 0;
      // Devices snap vertices to 1/256 of a texel: within that the depth may be that of a neighbouring place.
      ASSERT_NEAR(atlas.at(view.atlas_x + x, view.atlas_y + y), expected, 1e-5 * expected + spread)
          << what << ", texel " << x << ", " << y << ", triangle " << triangle;
    }
  }
}

TestScene few_casters() {
  TestScene scene;
  scene.meshes = {plane_mesh(1), box_mesh(), sphere_mesh(8, 12), masked_mesh()};
  scene.instances = {{.mesh = 0, .world_from_mesh = affine(glm::mat3(7), {0, -0.5f, 0})},
                     {.mesh = 1, .world_from_mesh = random_affine(4, {2, 0.6f, 1})},
                     {.mesh = 1,
                      .world_from_mesh = affine(glm::mat3(0.1f, 0, 0, 0, 3, 0, 0, 0, 0.1f), {-1, 1, 0.5f}),
                      .light_mask = 2},
                     {.mesh = 2, .world_from_mesh = random_affine(5, {-2.5f, 1.5f, -2})},
                     {.mesh = 3, .world_from_mesh = affine(glm::mat3(1.5f), {0.3f, 3.1f, 0.2f})},
                     {.mesh = 3, .world_from_mesh = random_affine(8, {0.5f, 1.2f, -2.5f})},
                     {.mesh = 1, .world_from_mesh = affine(glm::mat3(1), {0, 0.5f, 3}), .casts = false}};
  scene.lights = {{.position = {0.2f, 2, 0.1f}, .range_m = 9},
                  {.position = {-3, 1, 2}, .range_m = 12, .max_resolution = 40},  // of which 32 are used
                  {.type = LightType::spot,
                   .position = {3, 4, -1},
                   .direction = {-0.6f, -1, 0.2f},
                   .range_m = 12,
                   .outer_cone_rad = 0.6f},
                  {.type = LightType::spot,
                   .position = {1, 2.4f, 1},
                   .direction = {-0.3f, -0.2f, -1},
                   .range_m = 8,
                   .outer_cone_rad = 1.4f},
                  {.type = LightType::directional, .direction = {0.3f, -1, 0.45f}},
                  {.position = {1.8f, 1.5f, 0.9f}, .range_m = 10, .near_m = 1.3f, .light_mask = 1},
                  {.position = {5, 5, 5}, .range_m = 20, .casts_shadow = false},
                  {.type = LightType::directional, .direction = {-1, -0.01f, 0}, .max_resolution = 16}};
  return scene;
}

TEST_F(AtlasDepth, IsThatOfRaysThroughTheTexels) {
  const TestScene scene = few_casters();
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.add(scene);
  rig.show_nothing();
  for (const Writer writer : {Writer::multi_draw, Writer::traditional}) {
    rig.frame({.writer = writer, .max_resolution = 64});
    ASSERT_EQ(rig.map_resolution(), 64u);
    const Atlas atlas = rig.atlas();
    const auto lights = rig.lights();
    const auto views = rig.views();
    Tally tally;
    uint64_t beyond = 0;
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
      const shared::LightRecord& record = lights[slot_of(rig.light_ids[i])];
      const auto triangles = triangles_of(scene, scene.lights[i].light_mask);
      EXPECT_EQ(record.view_count, !scene.lights[i].casts_shadow ? 0 : record.views == shared::ViewsCube ? 6 : 1);
      for (uint32_t v = 0; v < record.view_count; ++v) {
        const shared::ShadowView& view = views[record.first_view + v];
        EXPECT_EQ(view.resolution, i == 1 ? 32u : i == 7 ? 16u : 64u);
        const std::string what = "light " + std::to_string(i) + ", view " + std::to_string(v) +
                                 (writer == Writer::traditional ? ", traditional" : "");
        expect_view(atlas, view, rays_of(scene.lights[i], record, view, v), triangles, what, tally);
        for (uint32_t y = 0; y < 64; ++y)
          for (uint32_t x = 0; x < 64; ++x)
            beyond +=
                (x >= view.resolution || y >= view.resolution) && atlas.at(view.atlas_x + x, view.atlas_y + y) != 0;
      }
    }
    EXPECT_EQ(beyond, 0u) << "texels drawn beyond a map that is smaller than its tile";
    EXPECT_LT(tally.unsure, tally.texels / 10) << "of " << tally.texels;
    EXPECT_GT(tally.drawn, tally.texels / 3);
  }
}

uint64_t different(const Atlas& a, const Atlas& b) {
  EXPECT_EQ(a.depth.size(), b.depth.size());
  uint64_t count = 0;
  for (size_t i = 0; i < std::min(a.depth.size(), b.depth.size()); ++i)
    count += std::memcmp(&a.depth[i], &b.depth[i], sizeof(float)) != 0;
  return count;
}

TEST_F(AtlasDepth, IsTheSameTwice) {
  for (const Writer writer : {Writer::multi_draw, Writer::traditional}) {
    std::vector<Atlas> atlases;
    for (int run = 0; run < 2; ++run) {
      SystemRig rig(gpu(), {.budget_mib = 16});
      rig.add(mixed_scene(120, 24, 5));
      rig.show_nothing();
      for (int frame = 0; frame < 2; ++frame) {
        rig.frame({.writer = writer, .max_resolution = 128});
        atlases.push_back(rig.atlas());
      }
    }
    for (const Atlas& atlas : atlases) EXPECT_EQ(different(atlas, atlases[0]), 0u);
  }
}

TEST_F(AtlasDepth, IsTheSameOfBothWriters) {
  SystemRig rig(gpu(), {.budget_mib = 16});
  rig.add(mixed_scene(120, 24, 5));
  rig.show_nothing();
  rig.frame({.writer = Writer::multi_draw, .max_resolution = 128});
  const Atlas at_once = rig.atlas();
  const Statistics at_once_statistics = rig.system().statistics();
  rig.frame({.writer = Writer::traditional, .max_resolution = 128});
  const Atlas by_view = rig.atlas();
  EXPECT_EQ(rig.system().statistics().batches_drawn, at_once_statistics.batches_drawn);
  EXPECT_EQ(rig.system().statistics().triangles_drawn, at_once_statistics.triangles_drawn);
  const auto drawn = std::count_if(at_once.depth.begin(), at_once.depth.end(), [](float depth) { return depth != 0; });
  EXPECT_GT(size_t(drawn), at_once.depth.size() / 10);
  EXPECT_EQ(different(at_once, by_view), 0u) << "of " << at_once.depth.size() << " texels";
}

}  // namespace
}  // namespace umbrage::test
