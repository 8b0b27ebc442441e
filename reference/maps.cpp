#include "reference/maps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

namespace reference {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr uint32_t kFinestLevel = 13, kCoarsestLevel = 2;  // 8192 and 4 texels
constexpr double kTapReachTexels = 1.55;                   // the nine texels' centres, and rounding
constexpr double kTapDepthTexels = 8;                      // and compare no deeper than this behind it

std::array<glm::dvec3, 8> corners(const Box& box) {
  std::array<glm::dvec3, 8> out;
  for (uint32_t i = 0; i < 8; ++i)
    out[i] = {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z};
  return out;
}

double cross(glm::dvec2 o, glm::dvec2 a, glm::dvec2 b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

/// Area of the convex hull.
double hull_area(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(),
            [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<glm::dvec2> hull;
  for (int half = 0; half < 2; ++half) {
    const size_t start = hull.size();
    for (const glm::dvec2 p : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // begins the other half
    std::reverse(points.begin(), points.end());
  }
  double area = 0;
  for (size_t i = 1; i + 1 < hull.size(); ++i) area += cross(hull[0], hull[i], hull[i + 1]) / 2;
  return area;
}

/// Farthest axis depth of the box on the light's views.
double farthest_depth(const MapLight& light, const Box& box) {
  double depth = light.kind == MapKind::spot ? light.near_m : 0;
  for (const glm::dvec3 corner : corners(box)) {
    const glm::dvec3 r = corner - light.position;
    depth = std::max(depth, light.kind == MapKind::spot ? glm::dot(r, light.direction)
                                                        : std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)}));
  }
  return depth;
}

double level_resolution(int level) { return std::exp2(std::clamp(level, int(kCoarsestLevel), int(kFinestLevel))); }

/// Whole pages, or below one page a power of two.
uint32_t allocated_resolution(double request) {
  const auto texels = uint32_t(std::clamp(std::ceil(request), 1.0, level_resolution(kFinestLevel)));
  if (texels >= page_side) return (texels + page_side - 1) / page_side * page_side;
  uint32_t side = 1u << kCoarsestLevel;
  while (side < texels) side *= 2;
  return side;
}

}  // namespace

Sphere sphere_around(const Box& box) {
  return {0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max)),
          0.5 * glm::distance(glm::dvec3(box.min), glm::dvec3(box.max))};
}

Sphere sphere_around(std::span<const glm::vec3> points) {
  Sphere sphere;
  for (const glm::vec3 p : points) sphere.center += glm::dvec3(p) / double(points.size());
  for (const glm::vec3 p : points) sphere.radius = std::max(sphere.radius, glm::distance(sphere.center, glm::dvec3(p)));
  return sphere;
}

double solid_angle(const Sphere& sphere, glm::dvec3 seen_from) {
  const double distance = glm::distance(sphere.center, seen_from);
  if (distance <= sphere.radius) return 4 * kPi;
  // 2 pi (1 - cos) by half the angle: nothing cancels where the sphere is far away.
  const double half_sine = std::sin(0.5 * std::asin(sphere.radius / distance));
  return 4 * kPi * half_sine * half_sine;
}

double covered_pixels(const MapCamera& camera, const Box& box) {
  std::vector<glm::dvec2> outline;
  for (const glm::dvec3 corner : corners(box)) {
    const glm::dvec4 clip = camera.clip_from_view * camera.view_from_world * glm::dvec4(corner, 1);
    if (clip.w <= 1e-6) return camera.tile_pixels;
    outline.push_back({0.5 * camera.width * clip.x / clip.w, 0.5 * camera.height * clip.y / clip.w});
  }
  return std::clamp(hull_area(outline), 1.0, camera.tile_pixels);
}

double nearest_pixel_m(const MapCamera& camera, const Box& box, double least_depth) {
  double depth = std::numeric_limits<double>::infinity();
  for (const glm::dvec3 corner : corners(box))
    depth = std::min(depth, camera.forward * (camera.view_from_world * glm::dvec4(corner, 1)).z);
  depth = std::max(depth, least_depth);
  // w is the depth of perspective cameras and 1 of orthographic ones.
  const double w = std::abs(camera.clip_from_view[2][3]) * depth + camera.clip_from_view[3][3];
  return std::min(2 * w / (std::abs(camera.clip_from_view[0][0]) * camera.width),
                  2 * w / (std::abs(camera.clip_from_view[1][1]) * camera.height));
}

double facing_away_rad(const MapLight& light, const Sphere& sphere, glm::dvec3 cone_axis, double cone_cosine) {
  if (cone_cosine <= 0) return -kPi;
  glm::dvec3 to_light = -light.direction;
  double spread = 0;
  if (light.kind != MapKind::sun) {
    const double distance = glm::distance(light.position, sphere.center);
    if (distance <= sphere.radius) return -kPi;
    to_light = (light.position - sphere.center) / distance;
    spread = std::asin(sphere.radius / distance);
  }
  return std::acos(std::clamp(glm::dot(cone_axis, to_light), -1.0, 1.0)) - std::acos(cone_cosine) - spread - kPi / 2;
}

double requested_resolution(const MapLight& light, const MapRules& rules, double pixels, const Sphere& sphere,
                            const Box& box, double pixel_m) {
  double wanted = 0;
  if (light.kind == MapKind::sun) {
    wanted = light.side_m / pixel_m;
  } else {
    const double square = light.tangent * light.tangent;
    const double view_angle = 4 * std::atan(square / std::sqrt(1 + 2 * square));
    const double alpha = solid_angle(sphere, light.position);
    wanted = std::sqrt(pixels / (alpha / view_angle));
    if (!rules.paper) {
      // A texel at a face's centre covers 6 / pi times the mean (E3); within the sphere alpha says nothing (E2).
      const bool within = glm::distance(sphere.center, light.position) <= sphere.radius;
      const double scaled = within ? 0 : std::sqrt(6 / kPi) * wanted;
      wanted = std::max(scaled, 2 * light.tangent * farthest_depth(light, box) / pixel_m);
    }
  }
  return std::min(std::clamp(wanted / rules.undersampling, rules.least, rules.most), light.max_resolution);
}

uint32_t place_of_request(double request, double finest, const MapRules& rules) {
  if (!rules.exact) {
    const double level = std::clamp(std::ceil(std::log2(request) - 0.5), double(kCoarsestLevel), double(kFinestLevel));
    return kFinestLevel - uint32_t(level);
  }
  const double below = rules.logarithmic ? std::log2(finest / request) : (1 - request / finest) * rules.maps_per_light;
  return uint32_t(std::clamp(std::floor(below), 0.0, double(rules.maps_per_light - 1)));
}

std::vector<uint32_t> map_resolutions(std::span<const double> requests, const MapRules& rules, uint32_t halvings) {
  if (requests.empty()) return {};
  const double finest = *std::max_element(requests.begin(), requests.end());
  std::vector<uint32_t> own;  // of each request, if there were any number of maps
  for (const double request : requests) {
    const uint32_t place = place_of_request(request, finest, rules);
    if (!rules.exact) {
      own.push_back(uint32_t(level_resolution(int(kFinestLevel) - int(place) - int(halvings))));
      continue;
    }
    double largest = 0;
    for (const double other : requests)
      if (place_of_request(other, finest, rules) == place) largest = std::max(largest, other);
    own.push_back(allocated_resolution(largest / std::exp2(halvings)));
  }
  std::set<uint32_t, std::greater<>> kept(own.begin(), own.end());
  while (kept.size() > rules.maps_per_light) kept.erase(std::prev(kept.end()));
  for (uint32_t& resolution : own) resolution = std::max(resolution, *kept.rbegin());
  return own;
}

double largest_facing(const MapLight& light, const ReceiverBlock& block) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double largest = -std::numeric_limits<double>::infinity();
    for (const double normal : {block.normals.min[axis], block.normals.max[axis]})
      for (const double position : {block.positions.min[axis], block.positions.max[axis]})
        largest = std::max(
            largest, normal * (light.kind == MapKind::sun ? -light.direction[axis] : light.position[axis] - position));
    sum += largest;
  }
  return sum;
}

ViewMarks no_marks(uint32_t resolution, uint32_t grid) {
  ViewMarks marks;
  marks.pages = (resolution + page_side - 1) / page_side;
  marks.page.assign(size_t(marks.pages) * marks.pages, false);
  marks.grid = grid;
  marks.farthest.assign(size_t(grid) * grid, 0);
  return marks;
}

namespace {

struct Range {
  double low, high;
};

/// The values that a row takes on in a box.
Range range_of(glm::dvec4 row, const Box& box, double grow_m) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const glm::dvec3 corner : corners(box)) {
    const double value = glm::dot(row, glm::dvec4(corner, 1));
    range = {std::min(range.low, value), std::max(range.high, value)};
  }
  const double grow = grow_m * (std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
  return {range.low - grow, range.high + grow};
}

/// A box in a view's coordinates.
struct Footprint {
  Range x, y, depth;
  bool perspective;
};

/// Whether some point of the footprint is seen within the window: there is a depth z > 0 at which s.low z ≤ x ≤ s.high z holds
/// for an x of the box, and likewise for y.
bool meets(const Footprint& box, Range s, Range t) {
  if (!box.perspective) return box.x.low <= s.high && box.x.high >= s.low && box.y.low <= t.high && box.y.high >= t.low;
  Range z{std::max(box.depth.low, 0.0), box.depth.high};
  const auto keep = [&](double a, double b) {  // a z ≤ b
    if (a > 0) z.high = std::min(z.high, b / a);
    if (a < 0) z.low = std::max(z.low, b / a);
    if (a == 0 && b < 0) z.high = -1;
  };
  keep(s.low, box.x.high), keep(-s.high, -box.x.low);
  keep(t.low, box.y.high), keep(-t.high, -box.y.low);
  return z.high > 0 && z.low <= z.high;
}

Range window(uint32_t i, uint32_t tiles, double tolerance) {
  const Range range{2.0 * i / tiles - 1, 2.0 * (i + 1) / tiles - 1};
  return {range.low - tolerance, range.high + tolerance};
}

/// World size of the taps' reach around the receivers of a box.
double reach_m(const MapLight& light, uint32_t resolution, const Box& box) {
  if (light.kind == MapKind::sun) return kTapReachTexels * light.side_m / resolution;
  MapLight behind = light;
  behind.near_m = 0;
  return kTapReachTexels * 2 * light.tangent * farthest_depth(behind, box) / resolution;
}

}  // namespace

void mark_receivers(const CasterView& view, const MapLight& light, uint32_t resolution, const Box& box,
                    double tolerance, double tolerance_m, ViewMarks& marks) {
  const double grow_m = reach_m(light, resolution, box) + tolerance_m;
  const Footprint seen{range_of(view.x, box, grow_m), range_of(view.y, box, grow_m), range_of(view.depth, box, grow_m),
                       view.perspective};
  const Range whole{-1 - tolerance, 1 + tolerance};
  if (seen.depth.low > seen.depth.high || seen.x.low > seen.x.high || seen.y.low > seen.y.high ||
      !meets(seen, whole, whole))
    return;
  marks.seen = true;
  const double texel = (light.kind == MapKind::sun ? light.side_m : 2 * light.tangent) / resolution;
  const double farthest = view.perspective
                              ? seen.depth.high * (1 + kTapDepthTexels * texel)
                              : seen.depth.high + kTapDepthTexels * texel * glm::length(glm::dvec3(view.depth));
  const auto each = [&](uint32_t tiles, const std::function<void(uint32_t, uint32_t)>& mark) {
    for (uint32_t y = 0; y < tiles; ++y) {
      if (!meets(seen, whole, window(y, tiles, tolerance))) continue;
      for (uint32_t x = 0; x < tiles; ++x)
        if (meets(seen, window(x, tiles, tolerance), window(y, tiles, tolerance))) mark(x, y);
    }
  };
  each(marks.pages, [&](uint32_t x, uint32_t y) { marks.page[size_t(y) * marks.pages + x] = true; });
  each(projection_side, [&](uint32_t x, uint32_t y) { marks.tiles[y] |= 1u << x; });
  each(marks.grid, [&](uint32_t x, uint32_t y) {
    double& cell = marks.farthest[size_t(y) * marks.grid + x];
    cell = std::max(cell, farthest);
  });
}

}  // namespace reference
