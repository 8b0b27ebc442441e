// The lights file of --lights, and of dumps: {"lights": [{"type": "point"|"spot"|"directional", "position": [x,y,z],
// "direction": [x,y,z], "color": [r,g,b], "intensity": I, "range": metres, "inner_cone_deg": a, "outer_cone_deg": b,
// "faces": "+x -y …", "name": "…"}]}, world space, units and falloff as in KHR_lights_punctual.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "host/renderer.hpp"
#include "import/scene.hpp"
#include "umbrage/result.hpp"

namespace app {

/// Needed: type; position of points and spots; direction of spots and directional lights (any length > 0). Left out:
/// color white, intensity 1, range infinite, inner_cone_deg 0, outer_cone_deg 45, all faces, no name. At most 64 MiB.
/// Errors name the place, such as "lights.json: lights[3].range must be > 0, is -2".
umbrage::Result<std::vector<PosedLight>> read_lights(const std::filesystem::path& path);

/// The same document for lights as used, every default filled in. Reading it back gives the same lights.
nlohmann::ordered_json lights_document(std::span<const ActiveLight> lights);

/// "point", "spot", "directional".
const char* kind_name(LightKind kind);

}  // namespace app
