// Clusters against the shaders' own math on the CPU: which are occupied, their order, boxes and normal cones, under every
// kind of camera; and what happens when there are more than there is room for.
#include <cmath>

#include "cluster_reader.hpp"

namespace umbrage::test {
namespace {

class Clusters : public GpuTest {};

struct Shot {
  const char* name;
  CameraDesc camera;
};

std::vector<Shot> shots() {
  const glm::vec3 eye(0, 5, 16), target(0, 1, 0);
  std::vector<Shot> all = {{"reversed infinite", perspective_camera(eye, target, 200, 137)},
                           {"finite", finite_camera(eye, target, 96, 64, 80)},
                           {"orthographic", orthographic_camera(eye, target, 130, 97, 8, 50)},
                           {"close to the ground", perspective_camera({0.3f, 0.02f, 3}, {0, 0, 0}, 160, 160)},
                           {"one pixel", perspective_camera(eye, target, 1, 1)}};
  return all;
}

/// Exactly the cells with samples are occupied, and they are numbered by tile, then slice.
void expect_cells(const DeviceClusters& clusters, const Receivers& seen, const std::string& name) {
  const shared::CameraRecord& camera = clusters.record.camera;
  const uint32_t tiles = camera.tiles.x * camera.tiles.y;
  std::vector<uint8_t> must(tiles * shared::MaxSlices), may(tiles * shared::MaxSlices);
  for (uint32_t i = 0; i < seen.depth.size(); ++i) {
    if (shared::is_background(seen.depth[i])) continue;
    const uint32_t tile = i / seen.width / shared::TileSide * camera.tiles.x + i % seen.width / shared::TileSide;
    const glm::uvec2 slices = slices_of(camera, seen.t[i]);
    for (uint32_t slice = slices.x; slice <= slices.y; ++slice) may[tile * shared::MaxSlices + slice] = 1;
    if (slices.x == slices.y) must[tile * shared::MaxSlices + slices.x] = 1;
  }
  uint32_t next = 0;
  for (uint32_t cell = 0; cell < tiles * shared::MaxSlices; ++cell) {
    const uint32_t tile = cell / shared::MaxSlices, slice = cell % shared::MaxSlices;
    const bool occupied = clusters.occupied(tile, slice);
    ASSERT_TRUE(occupied ? may[cell] : !must[cell]) << name << ": tile " << tile << ", slice " << slice;
    if (!occupied) continue;
    ASSERT_EQ(clusters.cluster_of(tile, slice), next) << name;
    ASSERT_EQ(clusters.cells[next], cell) << name;
    ++next;
  }
  EXPECT_EQ(clusters.counters.clusters, next) << name;
  EXPECT_EQ(clusters.counters.clusters_found, next) << name;
  EXPECT_GT(next, 0u) << name;
}

/// Every sample lies in the box and every normal in the cone of a cluster that it may belong to.
void expect_bounds(const DeviceClusters& clusters, const Receivers& seen, const std::string& name) {
  const shared::CameraRecord& camera = clusters.record.camera;
  for (uint32_t i = 0; i < seen.depth.size(); ++i) {
    if (shared::is_background(seen.depth[i])) continue;
    const uint32_t tile = i / seen.width / shared::TileSide * camera.tiles.x + i % seen.width / shared::TileSide;
    const glm::uvec2 slices = slices_of(camera, seen.t[i]);
    bool bounded = false;
    for (uint32_t slice = slices.x; slice <= slices.y; ++slice) {
      const uint32_t cluster = clusters.cluster_of(tile, slice);
      if (cluster == shared::NoIndex) continue;
      const glm::vec4 cone = clusters.cones[cluster];
      bounded = bounded || (holds(clusters.boxes[cluster], seen.positions[i]) &&
                            glm::dot(glm::vec3(cone), glm::vec3(seen.normals[i])) >= cone.w);
    }
    ASSERT_TRUE(bounded) << name << ": pixel " << i % seen.width << ", " << i / seen.width;
  }
}

TEST_F(Clusters, HoldTheSamplesOfEveryCamera) {
  SystemRig rig(gpu(), {.budget_mib = 4});
  for (const Shot& shot : shots()) {
    const Receivers seen = picture(shot.camera, balls_on_ground);
    rig.show(shot.camera, seen);
    rig.frame({.cluster_bounds = ClusterBounds::implicit_cell});
    const DeviceClusters loose(rig);
    expect_cells(loose, seen, shot.name);
    expect_bounds(loose, seen, shot.name);
    rig.frame({.cluster_bounds = ClusterBounds::explicit_bits});
    const DeviceClusters tight(rig);
    expect_cells(tight, seen, shot.name);
    expect_bounds(tight, seen, shot.name);
    ASSERT_EQ(tight.cells, loose.cells) << shot.name;

    double loose_volume = 0, tight_volume = 0;
    for (uint32_t c = 0; c < loose.cells.size(); ++c) {
      const shared::Box cell = shared::cell_box(loose.record.camera,
                                                {loose.cells[c] / shared::MaxSlices % loose.record.camera.tiles.x,
                                                 loose.cells[c] / shared::MaxSlices / loose.record.camera.tiles.x},
                                                loose.cells[c] % shared::MaxSlices);
      const glm::vec3 size = loose.boxes[c].hi - loose.boxes[c].lo;
      const float rounding = 2e-5f * (glm::length(loose.boxes[c].lo) + glm::length(loose.boxes[c].hi) +
                                      glm::length(loose.record.camera.origin));
      ASSERT_TRUE(holds(cell, loose.boxes[c].lo, rounding) && holds(loose.boxes[c], cell.lo, rounding))
          << shot.name << ": cluster " << c;
      ASSERT_TRUE(holds(cell, loose.boxes[c].hi, rounding) && holds(loose.boxes[c], cell.hi, rounding))
          << shot.name << ": cluster " << c;
      // explicit ⊆ implicit, but for the slack that explicit boxes are grown by.
      const float slack = 0.0011f * std::max({size.x, size.y, size.z}) + rounding;
      ASSERT_TRUE(holds(loose.boxes[c], tight.boxes[c].lo, slack) && holds(loose.boxes[c], tight.boxes[c].hi, slack))
          << shot.name << ": cluster " << c;
      const glm::vec3 tight_size = tight.boxes[c].hi - tight.boxes[c].lo;
      loose_volume += double(size.x) * size.y * size.z,
          tight_volume += double(tight_size.x) * tight_size.y * tight_size.z;
      ASSERT_TRUE(tight.cones[c] == loose.cones[c]) << shot.name;
    }
    EXPECT_LT(tight_volume, 0.9 * loose_volume) << shot.name;
  }
}

TEST_F(Clusters, ConesHoldEveryDirectionWithoutNormals) {
  SystemRig rig(gpu(), {.budget_mib = 4});
  CameraDesc camera = perspective_camera({0, 5, 16}, {0, 1, 0}, 96, 64);
  Receivers seen = picture(camera, balls_on_ground);
  seen.normals.assign(seen.normals.size(), glm::vec4(0));  // no directions
  rig.show(camera, seen);
  rig.frame();
  for (const glm::vec4& cone : DeviceClusters(rig).cones) EXPECT_EQ(cone.w, -1.0f);
  camera.normal_encoding = NormalEncoding::none;
  rig.show(camera, seen);
  rig.frame();
  for (const glm::vec4& cone : DeviceClusters(rig).cones) EXPECT_EQ(cone.w, -1.0f);
}

TEST_F(Clusters, BackgroundMakesNone) {
  SystemRig rig(gpu(), {.budget_mib = 4});
  rig.add(mixed_scene(5, 5, 1));
  rig.show_nothing();
  rig.camera().other_receivers = false;
  rig.frame();
  EXPECT_EQ(rig.system().statistics().clusters, 0u);
  EXPECT_EQ(rig.system().statistics().lights_visible, 0u);
  EXPECT_EQ(rig.system().statistics().shadow_views, 0u);
}

/// Depths all over the range in every tile: more clusters than there is room for.
TEST_F(Clusters, BeyondTheirRoomTakeAllLights) {
  const CameraDesc camera = perspective_camera({0, 5, 16}, {0, 1, 0}, 640, 448);
  uint32_t pixel = 0;
  const Receivers noise = picture(camera, [&](const glm::vec3&, const glm::vec3&) {
    pixel = pixel * 1664525u + 1013904223u;
    return Surface{0.1f * std::exp2(float(pixel >> 8) / float(1 << 24) * 10), {0, 1, 0}};
  });
  SystemRig rig(gpu(), {.budget_mib = 4});
  const TestScene scene = mixed_scene(30, 24, 3);
  rig.add(scene);
  rig.show(camera, noise);
  rig.frame();
  const DeviceClusters clusters(rig);
  ASSERT_GT(clusters.counters.clusters_found, clusters.record.cluster_capacity);
  EXPECT_EQ(clusters.counters.clusters, clusters.record.cluster_capacity);
  EXPECT_EQ(rig.system().statistics().clusters, clusters.counters.clusters_found);
  EXPECT_EQ(rig.system().statistics().overflows, 1u);
  // Clusters without a number are looked up with every light, so every light needs its map.
  EXPECT_EQ(rig.system().statistics().lights_visible, scene.lights.size());
  for (const shared::ShadowView& view : rig.views()) EXPECT_NE(view.light, shared::NoIndex);
}

}  // namespace
}  // namespace umbrage::test
