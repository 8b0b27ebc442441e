// The shape of a glTF document: which properties the importer reads and what they must be.
#pragma once
#include <nlohmann/json.hpp>

namespace app::gltf {

/// A copy that holds the known properties only, each of its declared kind: a property of another kind is refused with
/// its place. Integers written as floats (1.0) become integers; extras and unknown extensions are gone, so the copy is
/// nested no deeper than the schema.
nlohmann::json checked_copy(const nlohmann::json& document);

}  // namespace app::gltf
