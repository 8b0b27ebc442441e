// glTF 2.0 files (.gltf, .glb) as scenes. Nothing in the file is trusted: see gltf_limits.hpp for what bounds it.
#pragma once
#include <filesystem>

#include "import/scene.hpp"
#include "umbrage/result.hpp"

namespace app {

/// Reads the document's default scene, its first one, or all root nodes where there is no scene; an empty document is
/// an empty scene. Left out: points, lines, primitives without positions, and what lies in buffers without a uri, whose
/// content glTF leaves to extensions. Materials and meshes keep the file's order, with one default material appended.
/// Extensions: KHR_lights_punctual, KHR_texture_transform, KHR_mesh_quantization, KHR_materials_unlit,
/// KHR_materials_emissive_strength, KHR_materials_pbrSpecularGlossiness (its diffuse part and glossiness); a file that
/// requires another one is refused. Errors: invalid_argument ("<file>: <place>: <fault>"), unsupported (a required
/// extension, glTF 1.0), out_of_memory.
umbrage::Result<Scene> import_gltf(const std::filesystem::path& file);

}  // namespace app
