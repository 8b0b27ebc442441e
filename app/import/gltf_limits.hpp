// Every limit of the importer. Together with the size of the file they bound memory and time; what exceeds one is
// refused.
#pragma once
#include <cstddef>
#include <cstdint>

namespace app::gltf {

/// A .gltf, .glb or buffer file. The parsed JSON takes up to some 30 times its text.
constexpr uint64_t max_file_bytes = uint64_t{4} << 30;
constexpr uint64_t max_json_bytes = uint64_t{256} << 20;
/// Elements of one list of objects: nodes, meshes, accessors and so on.
constexpr size_t max_objects = size_t{1} << 20;
/// Elements of lists whose entries are large in memory (materials take 2 KiB each however short their text).
constexpr size_t max_large_objects = size_t{1} << 16;
/// Numbers decoded from accessors may take this many bytes and `decoded_per_file_byte` for each byte of the file and
/// its buffers. An honest file needs about 12 (one-byte strip indices become three four-byte ones); a file that refers
/// to the same data over and over needs any amount.
constexpr uint64_t decoded_bytes_base = uint64_t{64} << 20;
constexpr uint64_t decoded_per_file_byte = 64;
/// Pixels along a side of an image.
constexpr int max_image_side = 16384;
/// RGBA bytes of all images together.
constexpr uint64_t max_image_bytes = uint64_t{8} << 30;
/// Joints summed over skinned nodes, and morph weights summed over morphed nodes: a pose holds one of each.
constexpr size_t max_pose_elements = size_t{1} << 22;

}  // namespace app::gltf
