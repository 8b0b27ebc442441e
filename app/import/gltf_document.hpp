// A .gltf or .glb file as text and bytes, before any of it is interpreted.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace app::gltf {

struct Document {
  std::filesystem::path folder;  ///< What relative URIs start from.
  std::vector<uint8_t> bytes;    ///< The whole file; json and binary point into it.
  std::string_view json;
  std::span<const uint8_t> binary;  ///< The BIN chunk of a .glb; empty: there is none.
};

/// GLB is recognised by its first bytes, not by the name.
Document read_document(const std::filesystem::path&);
/// The first max_bytes of a regular file, or all of it.
std::vector<uint8_t> read_file(const std::filesystem::path&, uint64_t max_bytes);
/// Of a relative URI or a data: URI with base64. The result has at least min_bytes, else the URI is refused.
std::vector<uint8_t> read_uri(const Document&, const std::string& uri, uint64_t min_bytes, uint64_t max_bytes);

}  // namespace app::gltf
