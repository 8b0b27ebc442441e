// Reference of light assignment: every light against every cluster.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "reference/box.hpp"
#include "reference/light.hpp"

namespace reference {

/// True where a sphere of the light's range meets the box. Directional lights meet every box.
bool range_meets(const Light&, const Box&);

/// True unless the cone of a spot certainly misses the box's bounding sphere: conservative. True for other lights.
bool cone_may_meet(const Light&, const Box&);

/// For each box the indices of the lights that may reach it (range_meets and cone_may_meet), ascending.
std::vector<std::vector<uint32_t>> assign_lights(std::span<const Box> boxes, std::span<const Light> lights);

/// The indices of the lights that do reach at least one of the positions, ascending: what any list must hold.
std::vector<uint32_t> lights_reaching(std::span<const glm::vec3> positions, std::span<const Light> lights);

}  // namespace reference
