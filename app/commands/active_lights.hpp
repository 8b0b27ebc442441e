// Which lights a frame has, with every default filled in: the scene's, those of the lights file, the random ones.
#pragma once
#include <span>
#include <vector>

#include "commands/surfaces.hpp"
#include "host/renderer.hpp"
#include "import/scene.hpp"

namespace app {

/// Irradiance (lux) under which a light without a range counts for nothing: a white surface then returns 0.01/π, less
/// than one step of an 8-bit picture's middle tones.
inline constexpr double kIrradianceThreshold = 0.01;

/// A light without a range gets the distance where intensity · its brightest colour component / distance² falls to
/// the threshold, but at most twice the distance to the scene's farthest corner: nothing is beyond.
ActiveLight activate(const PosedLight& light, double irradiance_threshold, const Box& bounds);

/// The scene's lights, then the added ones.
std::vector<ActiveLight> active_lights(std::span<const PosedLight> scene_lights, std::span<const PosedLight> added,
                                       double irradiance_threshold, const Box& bounds);

}  // namespace app
