// All in double precision; the record is rounded once.
#include "clusters/camera.hpp"

#include <algorithm>
#include <cmath>

namespace umbrage::clusters {

namespace {
Error invalid(const char* text) { return {ErrorCode::invalid_argument, std::string("CameraDesc: ") + text}; }

glm::dmat4 matrix(const Mat4& m) {
  glm::dmat4 out;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) out[c][r] = m.m[4 * c + r];
  return out;
}

bool finite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

/// The view-space x and y at which clip x = X w and clip y = Y w, as affine functions of (X, Y) at a view depth: the part
/// that is constant in depth and the part that is proportional to it.
struct Unprojection {
  glm::dvec2 constant, per_x, per_y;
};

Unprojection unproject(const glm::dmat2& inverse, double w, const glm::dvec2& offset) {
  return {inverse * -offset, inverse * glm::dvec2(w, 0), inverse * glm::dvec2(0, w)};
}
}  // namespace

Result<shared::CameraRecord> camera_record(const CameraDesc& desc) {
  const glm::dmat4 view = matrix(desc.view_from_world), clip = matrix(desc.clip_from_view);
  if (!finite(view) || !finite(clip)) return invalid("the matrices must be finite");
  if (desc.width == 0 || desc.height == 0 || desc.width > 16384 || desc.height > 16384)
    return invalid("width and height must be 1…16384");
  if (std::abs(glm::determinant(view)) < 1e-12) return invalid("view_from_world is singular");
  const glm::dmat2 xy(clip[0][0], clip[0][1], clip[1][0], clip[1][1]);
  if (!(std::abs(glm::determinant(xy)) > 0)) return invalid("clip_from_view is singular");
  const double w_of_z = clip[2][3], w_of_1 = clip[3][3];
  const bool perspective = std::abs(w_of_z) > 1e-9;
  if (clip[0][3] != 0 || clip[1][3] != 0 || (perspective && std::abs(w_of_1) > 1e-9) ||
      (!perspective && std::abs(w_of_1) < 1e-9))
    return invalid("clip_from_view is neither a perspective nor an orthographic projection");

  // t is the distance along the axis that the camera looks: ±z of the view.
  const double sign = perspective ? (w_of_z > 0 ? 1.0 : -1.0) : -1.0;
  const double w = perspective ? std::abs(w_of_z) : w_of_1;
  const glm::dmat2 inverse = glm::inverse(xy);
  // Perspective: clip x = X (w t) and z_view = sign t, so everything but the offsets scales with t.
  const Unprojection constant =
      perspective ? unproject(inverse, 0, {clip[3][0], clip[3][1]}) : unproject(inverse, w, {clip[3][0], clip[3][1]});
  const Unprojection linear = perspective ? unproject(inverse, w, glm::dvec2(clip[2][0], clip[2][1]) * sign)
                                          : unproject(inverse, 0, glm::dvec2(clip[2][0], clip[2][1]) * sign);
  const glm::dmat4 world = glm::inverse(view);
  const auto direction = [&](const glm::dvec2& p, double z) { return glm::vec3(world * glm::dvec4(p, z, 0)); };
  shared::CameraRecord out{};
  out.origin = glm::vec3(world * glm::dvec4(constant.constant, 0, 1));
  out.origin_x = direction(constant.per_x, 0);
  out.origin_y = direction(constant.per_y, 0);
  out.ray = direction(linear.constant, sign);
  out.ray_x = direction(linear.per_x, 0);
  out.ray_y = direction(linear.per_y, 0);
  out.t_row = {glm::vec3(sign * view[0][2], sign * view[1][2], sign * view[2][2]),
               static_cast<float>(sign * view[3][2])};
  out.clip_from_world = glm::mat4(clip * view);

  // Depth z/w = d', with d' = d or 2d - 1.
  const double scale = desc.opengl_depth ? 2 : 1, bias = desc.opengl_depth ? -1 : 0;
  const double a = clip[2][2] * sign, b = clip[3][2];
  double t_first, t_last;
  if (perspective) {
    // (a t + b) / (w t) = d'
    out.depth_to_t = {b, 0, w * bias - a, w * scale};
    const double at_zero = b / (w * bias - a), at_one = b / (w * (scale + bias) - a);
    const auto usable = [](double t) { return std::isfinite(t) && t > 0; };
    const double near_t = usable(at_zero) && usable(at_one) ? std::min(at_zero, at_one)
                          : usable(at_zero)                 ? at_zero
                                                            : at_one;
    if (!usable(near_t)) return invalid("clip_from_view has no near plane in front of the camera");
    t_first = near_t;
    t_last = usable(at_zero) && usable(at_one) ? std::max(at_zero, at_one) : INFINITY;
  } else {
    if (a == 0) return invalid("clip_from_view has no depth");
    // a t + b = d' w
    out.depth_to_t = {(bias * w - b) / a, scale * w / a, 1, 0};
    const double at_zero = (bias * w - b) / a, at_one = ((scale + bias) * w - b) / a;
    t_first = std::min(at_zero, at_one);
    t_last = std::max(at_zero, at_one);
  }

  out.size = {desc.width, desc.height};
  out.tiles = (out.size + glm::uvec2(shared::TileSide - 1)) / shared::TileSide;
  out.end_tile = out.tiles.x * out.tiles.y;
  out.slice_origin = static_cast<float>(t_first);
  out.slices_are_logarithmic = perspective;
  // Cells as deep as a tile is high (Olsson et al. 2012: self-similar subdivision), and no more of them than there is room for.
  const double tile_ndc = 2.0 * shared::TileSide / desc.height;
  if (perspective) {
    const double tile_height = glm::length(glm::dvec3(out.ray_y)) * tile_ndc;
    double steps_per_octave = 1 / std::log2(1 + tile_height);
    double octaves =
        std::isfinite(t_last) ? std::max(std::log2(t_last / t_first), 1e-3) : shared::MaxSlices / steps_per_octave;
    if (octaves * steps_per_octave > shared::MaxSlices) steps_per_octave = shared::MaxSlices / octaves;
    out.slice_scale = static_cast<float>(steps_per_octave);
    out.slice_count =
        static_cast<uint32_t>(std::clamp(std::ceil(octaves * steps_per_octave), 1.0, double(shared::MaxSlices)));
  } else {
    const double tile_height = glm::length(glm::dvec3(out.origin_y)) * tile_ndc;
    const double slices =
        std::clamp(std::ceil((t_last - t_first) / std::max(tile_height, 1e-12)), 1.0, double(shared::MaxSlices));
    out.slice_scale = static_cast<float>(slices / (t_last - t_first));
    out.slice_count = static_cast<uint32_t>(slices);
  }
  return out;
}

}  // namespace umbrage::clusters
