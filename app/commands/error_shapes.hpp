// Tells apart what an eye sees in wrong shadows of one light: acne, leaks, shadows detached from their casters.
#pragma once
#include <cstdint>
#include <span>

#include "reference/ray_tracer.hpp"

namespace app {

/// Of one pixel for one light. Errors inside the texel band count as none: shadow edges have a width.
enum class ErrorKind : uint8_t { none, false_lit, false_dark, not_evaluated = 255 };

/// Pixels by kind. "Alike" means evaluated with normals within 11° (cosine ≥ 0.98).
struct ErrorShapes {
  /// False-dark pixels in a mixture: of the pixels alike in the 5 × 5 around it, itself included, at least 8 in
  /// number, at least a fifth are false-dark and at least a fifth are not.
  uint64_t acne = 0;
  /// Pixels of 8-connected false-lit patches that are more than 3 pixels thick: that hold a full square of 4 × 4.
  uint64_t leak = 0;
  /// Pixels of the thinner patches that touch, by a side or corner, a pixel not alike or not evaluated: light between a
  /// caster and its contact shadow.
  uint64_t detached = 0;
};

/// errors: an ErrorKind for each pixel of the image.
ErrorShapes find_error_shapes(const reference::SurfaceImage& image, std::span<const uint8_t> errors);

}  // namespace app
