// Exact Euclidean distances between pixels: Felzenszwalb and Huttenlocher, Distance Transforms of Sampled Functions,
// 2012.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace reference {

/// Where there is no other pixel to measure to.
constexpr uint32_t no_distance = std::numeric_limits<uint32_t>::max();

/// Squared distance in pixels from each pixel to the nearest one with mark != 0, row-major. Exact in integers.
/// Preconditions: marks.size() == width × height; both sides below 32768.
std::vector<uint32_t> squared_distances(std::span<const uint8_t> marks, uint32_t width, uint32_t height);

/// For each pixel with value 0 or 1, the squared distance to the nearest pixel with the other of the two; no_distance
/// for pixels with any other value and where the other value is nowhere. Work is bounded by the box of pixels with 0
/// or 1.
std::vector<uint32_t> squared_distances_to_other(std::span<const uint8_t> values, uint32_t width, uint32_t height);

}  // namespace reference
