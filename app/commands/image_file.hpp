// Pictures as PNG files, one or a numbered sequence.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "commands/output.hpp"
#include "umbrage/result.hpp"

namespace app {

/// RGBA rows (8-bit, row 0 at the top) as a PNG without alpha.
umbrage::Result<void> write_png(Outputs& outputs, const std::filesystem::path& target, uint32_t width, uint32_t height,
                                std::span<const uint8_t> rgba);

/// How often the name has a place for the frame's number: %d, or %0Nd for N digits with leading zeros.
uint32_t count_number_places(const std::string& name);
/// "frame-%04d.png", 7 → "frame-0007.png". A name without a place stays as it is.
std::string numbered_name(const std::string& name, uint32_t number);

}  // namespace app
