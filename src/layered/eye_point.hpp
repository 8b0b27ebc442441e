// Where a view looks from, recovered from its matrix: what in-shader back-face culling needs (E14), for any matrix.
#pragma once
#include "core/shared_math.h"
#include "umbrage/layered_pass.hpp"

namespace umbrage::layered {

struct EyePoint {
  shared::vec4 eye{0, 0, 0, 0};  ///< w = 1: a point; w = 0: a direction towards the viewer, for parallel views.
  bool is_mirrored =
      false;  ///< Front faces, counter-clockwise seen from outside, turn counter-clockwise in Vulkan's framebuffer.
};

EyePoint eye_point(const Mat4& clip_from_world, DepthOrder);

}  // namespace umbrage::layered
