// --random-lights: point lights of varied size and colour over surfaces that the scene's cameras see.
#pragma once
#include <cstdint>
#include <vector>

#include "commands/surfaces.hpp"
#include "import/scene.hpp"
#include "umbrage/result.hpp"

namespace app {

/// count lights, evenly spread over what the pose's cameras see (without cameras, or when they see nothing: over all
/// surfaces), each close to such a surface and bright enough to be seen there: 0.8 lux or more where it faces the light.
/// A light reaches about as far as its neighbours are away. The same scene, pose, count and seed give the same lights.
/// Errors: the scene has no surface.
umbrage::Result<std::vector<PosedLight>> random_lights(const Scene& scene, const Pose& pose, const Box& bounds,
                                                       uint32_t count, uint64_t seed);

}  // namespace app
