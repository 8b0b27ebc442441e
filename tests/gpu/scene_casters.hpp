// The casters of a test's scene in a GpuScene: masked ones with the rigs' mask, checkers of a quarter of its side.
#pragma once
#include "gpu.hpp"
#include "scene/gpu_scene.hpp"
#include "test_scene.hpp"

namespace umbrage::test {

struct SceneCasters {
  Image mask;
  std::vector<MeshId> meshes;
  std::vector<InstanceId> instances;
};
SceneCasters add_casters(Gpu&, scene::GpuScene&, const TestScene&);

}  // namespace umbrage::test
