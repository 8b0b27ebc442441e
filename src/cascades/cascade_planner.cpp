// All in double precision; what the device gets is rounded once.
#include "cascades/cascade_planner.hpp"

#include <algorithm>
#include <cmath>

namespace umbrage::cascades {

namespace {
/// Where volumes may begin, so that grid coordinates in them stay exact.
constexpr double kMostOrigin = shared::MostTexels - 65536, kMostDepthOrigin = shared::MostUnits - 131072;

/// 0.8 % at most: seven bits after the first.
double rounded_up(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::ceil(mantissa * 256) / 256, exponent);
}

struct Axes {
  glm::dvec3 right, down, forward;
};

Axes axes_of(const CascadeLight& light) {
  const glm::mat3 rows = glm::transpose(shared::view_rotation(light.direction_ws));
  return {glm::dvec3(rows[0]), glm::dvec3(rows[1]), glm::dvec3(rows[2])};
}

int whole(double value, double most) { return static_cast<int>(std::floor(std::clamp(value, -most, most))); }

/// The volume's first texel and depth unit, with the middle of the sub-frustum's box in its middle.
glm::ivec3 origin_around(const std::array<glm::dvec3, 8>& corners, const Axes& axes, const VolumeSize& size,
                         double reach_m) {
  glm::dvec3 lo(INFINITY), hi(-INFINITY);
  for (const glm::dvec3& corner : corners) {
    const glm::dvec3 p(glm::dot(axes.right, corner), glm::dot(axes.down, corner), glm::dot(axes.forward, corner));
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  const glm::dvec3 centre = (lo + hi) * 0.5;
  const int half_side = static_cast<int>(size.side / 2);
  const double near_m = centre.z - size.diameter_m / 2 - reach_m;
  return {whole(centre.x / size.texel_m, kMostOrigin) - half_side,
          whole(centre.y / size.texel_m, kMostOrigin) - half_side,
          whole(near_m / size.unit_m, kMostDepthOrigin) - 1 - size.guard_units};
}

/// May a volume of the frame before stay, with the sub-frustum somewhere else in its guard band?
bool guard_holds(const glm::ivec3& wanted, const glm::ivec3& former, const VolumeSize& size,
                 const CascadeSettings& settings) {
  const glm::ivec3 by = glm::abs(wanted - former);
  return std::max(by.x, by.y) <= static_cast<int>(settings.guard_texels) && by.z <= size.guard_units;
}
}  // namespace

std::array<double, kMostOfLight> split_depths(double near_m, const CascadeSettings& settings) {
  const double end = std::max(double(settings.distance_m), near_m * 1.001), begin = std::max(near_m, end * 1e-4);
  std::array<double, kMostOfLight> splits{};
  for (uint32_t i = 1; i <= settings.count; ++i) {
    const double part = double(i) / settings.count;
    const double even = begin + (end - begin) * part, geometric = begin * std::pow(end / begin, part);
    splits[i - 1] = i == settings.count ? end : even + (geometric - even) * settings.log_share;
  }
  return splits;
}

std::array<glm::dvec3, 8> frustum_corners(const shared::CameraRecord& camera, double begin_m, double end_m) {
  std::array<glm::dvec3, 8> corners;
  for (uint32_t i = 0; i < 8; ++i) {
    const double x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, t = i & 4 ? end_m : begin_m;
    corners[i] = glm::dvec3(camera.origin) + glm::dvec3(camera.origin_x) * x + glm::dvec3(camera.origin_y) * y +
                 (glm::dvec3(camera.ray) + glm::dvec3(camera.ray_x) * x + glm::dvec3(camera.ray_y) * y) * t;
  }
  return corners;
}

double diameter_of(const std::array<glm::dvec3, 8>& corners) {
  double most = 0;
  for (const glm::dvec3& a : corners)
    for (const glm::dvec3& b : corners) most = std::max(most, glm::distance(a, b));
  return most;
}

VolumeSize volume_size(double diameter_m, const CascadeSettings& settings, const std::optional<VolumeSize>& former) {
  const bool is_same = former && diameter_m <= former->diameter_m && diameter_m >= former->diameter_m * (1 - 1.0 / 64);
  VolumeSize size;
  size.diameter_m = is_same ? former->diameter_m : rounded_up(diameter_m);
  // A texel on each side, because the volume moves by whole ones (C7); a unit of depth likewise.
  size.texel_m = size.diameter_m / (settings.resolution - 2);
  const uint32_t guard = settings.mode == Mode::guard_band ? settings.guard_texels : 0;
  size.side = settings.resolution + 2 * guard;
  const double guard_m = guard * size.texel_m;
  size.unit_m = (size.diameter_m + settings.reach_m + 2 * guard_m) / (shared::FarDepth - 4);
  size.guard_units = static_cast<int>(guard_m / size.unit_m);
  return size;
}

std::span<const shared::CascadeRecord> CascadePlanner::plan(const shared::CameraRecord& camera,
                                                            std::span<const CascadeLight> lights,
                                                            const CascadeSettings& settings, bool is_continued) {
  const bool is_known = is_continued && settings == settings_ && known_.size() == lights.size() * settings.count;
  const std::array<double, kMostOfLight> splits = split_depths(camera.slice_origin, settings);
  if (!is_known) known_.assign(lights.size() * settings.count, {});
  settings_ = settings;
  records_.clear();
  texels_ = 0;
  for (size_t i = 0; i < known_.size(); ++i) {
    const CascadeLight& light = lights[i / settings.count];
    const size_t split = i % settings.count;
    // What the cascade before fades into belongs to this one too.
    const double former_end = split ? splits[split - 1] : camera.slice_origin;
    const double overlap =
        split ? (former_end - (split > 1 ? splits[split - 2] : camera.slice_origin)) * settings.blend : 0;
    const auto corners = frustum_corners(camera, former_end - overlap, splits[split]);
    Known& known = known_[i];
    const bool had_light = is_known && known.light == light;
    const VolumeSize size =
        volume_size(diameter_of(corners), settings, had_light ? std::optional(known.size) : std::nullopt);
    const Axes axes = axes_of(light);
    Known next{light, size, origin_around(corners, axes, size, settings.reach_m)};
    const bool translates = had_light && size == known.size;
    if (settings.mode == Mode::guard_band && translates && guard_holds(next.origin, known.origin, size, settings))
      next.origin = known.origin;
    const bool scrolls = settings.mode == Mode::scrolled || settings.mode == Mode::scrolled_literal;
    const bool holds = translates && settings.mode != Mode::redraw && (scrolls || next.origin == known.origin);
    shared::CascadeRecord& record = records_.emplace_back();
    record = {.x_row = glm::vec3(axes.right / size.texel_m),
              .texel_m = static_cast<float>(size.texel_m),
              .y_row = glm::vec3(axes.down / size.texel_m),
              .unit_m = static_cast<float>(size.unit_m),
              .z_row = glm::vec3(axes.forward / size.unit_m),
              .light = light.slot,
              .origin = next.origin,
              .side = size.side,
              .former = holds ? known.origin : next.origin,
              .flags = holds ? shared::CascadeHolds : 0,
              .first_texel = texels_,
              .light_mask = light.light_mask,
              .begin_m = static_cast<float>(former_end),
              .end_m = static_cast<float>(splits[split])};
    if (settings.mode == Mode::scrolled_literal) record.flags |= shared::CascadeLiteral;
    if (settings.mode == Mode::redraw) record.flags |= shared::CascadeAllStatic;
    texels_ += size.side * size.side;
    known = next;
  }
  return records_;
}

}  // namespace umbrage::cascades
