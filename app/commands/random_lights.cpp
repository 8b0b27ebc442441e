// --random-lights.
#include "commands/random_lights.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "commands/parse.hpp"
#include "commands/visibility_buffer.hpp"

namespace app {
namespace {

constexpr float kSmallestReach = 0.6f, kLargestReach = 2.2f;     // In distances between neighbouring lights.
constexpr float kSmallestHeight = 0.1f, kLargestHeight = 0.35f;  // Over the surface, in ranges.
constexpr float kIntensityPerRange2 = 0.1f;  // Candela; 0.1 / 0.35² · (1 - 0.35⁴) = 0.8 lux at the least.

/// The same numbers everywhere: the standard's engine, but not its distributions, which differ between libraries.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  float between(float low, float high) { return low + (high - low) * static_cast<float>(uniform()); }

 private:
  std::mt19937_64 engine_;
};

/// A saturated but never dark colour; its largest component is 1.
glm::vec3 random_color(Random& random) {
  const float hue = random.between(0, 6), saturation = random.between(0.2f, 0.75f);
  const auto component = [&](float offset) {
    const float k = std::fmod(offset + hue, 6.0f);
    return 1 - saturation * std::clamp(std::min(k, 4 - k), 0.0f, 1.0f);
  };
  return {component(5), component(3), component(1)};
}

float random_range(Random& random, float spacing, const Box& bounds) {
  const float reach = kSmallestReach * std::pow(kLargestReach / kSmallestReach, static_cast<float>(random.uniform()));
  return std::clamp(spacing * reach, 1e-4f * bounds.diagonal(), 0.25f * bounds.diagonal());
}

PosedLight make_light(Random& random, size_t index, float range) {
  PosedLight light;
  light.name = "random-" + std::to_string(index);
  light.color = random_color(random);
  light.range = range;
  light.intensity = kIntensityPerRange2 * range * range;
  return light;
}

/// A seen surface point, the buffer that saw it, and the running sum of weights up to and with it.
struct Candidate {
  SurfacePoint point;
  uint32_t buffer = 0;
  double weight = 0, weight_sum = 0;
};

std::vector<Candidate> seen_points(const std::vector<VisibilityBuffer>& buffers) {
  std::vector<Candidate> candidates;
  double sum = 0;
  for (uint32_t b = 0; b < buffers.size(); ++b) {
    for (uint32_t y = 0; y < VisibilityBuffer::kHeight; ++y) {
      for (uint32_t x = 0; x < VisibilityBuffer::kWidth; ++x) {
        const auto point = buffers[b].at(x, y);
        // Between even in the picture (weight 1) and even over the surfaces (its square): near and far get their share.
        const double weight = point ? std::sqrt(double(point->area)) : 0;
        if (!(weight > 0) || !std::isfinite(weight)) continue;
        sum += weight;
        candidates.push_back({*point, b, weight, sum});
      }
    }
  }
  return candidates;
}

/// Over the surface and in sight: lower where something is in the way, at last on the line of sight, which is free.
glm::vec3 place_over(Random& random, const SurfacePoint& point, const VisibilityBuffer& buffer, float range) {
  float height = range * random.between(kSmallestHeight, kLargestHeight);
  for (int attempt = 0; attempt < 6; ++attempt, height *= 0.6f) {
    const glm::vec3 position = point.position + height * point.normal;
    if (buffer.sees(position)) return position;
  }
  return point.position + std::min(height, 0.5f * point.depth) * buffer.toward_camera(point.position);
}

std::vector<PosedLight> lights_in_sight(const std::vector<VisibilityBuffer>& buffers,
                                        const std::vector<Candidate>& candidates, const Box& bounds, uint32_t count,
                                        uint64_t seed) {
  Random random(seed);
  const double total = candidates.back().weight_sum;
  std::vector<PosedLight> lights;
  lights.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    // One sample per equal share of the weight: evenly spread, yet random within the share.
    const double at = (i + random.uniform()) / count * total;
    const auto found = std::upper_bound(candidates.begin(), candidates.end(), at,
                                        [](double value, const Candidate& c) { return value < c.weight_sum; });
    const Candidate& candidate = found == candidates.end() ? candidates.back() : *found;
    const double lights_per_area = count * candidate.weight / total / double(candidate.point.area);
    const auto spacing = static_cast<float>(1 / std::sqrt(lights_per_area));
    PosedLight light = make_light(random, i, random_range(random, spacing, bounds));
    light.position = place_over(random, candidate.point, buffers[candidate.buffer], light.range);
    lights.push_back(std::move(light));
  }
  return lights;
}

/// Twice the area along the normal.
glm::dvec3 area_vector(const PosedPrimitive& posed, size_t first_index) {
  const std::vector<uint32_t>& indices = posed.primitive->indices;
  const glm::dvec3 a(posed.positions[indices[first_index]]), b(posed.positions[indices[first_index + 1]]),
      c(posed.positions[indices[first_index + 2]]);
  const glm::dvec3 across = glm::cross(b - a, c - a);
  return std::isfinite(glm::dot(across, across)) ? across : glm::dvec3(0);
}

/// Calls visit(posed, first_index, area) for every triangle that may cast a shadow.
void for_each_triangle(const Scene& scene, const Pose& pose,
                       const std::function<void(const PosedPrimitive&, size_t, double)>& visit) {
  for_each_primitive(scene, pose, [&](const PosedPrimitive& posed) {
    if (scene.materials[posed.primitive->material].alpha_mode == AlphaMode::blend) return;
    for (size_t i = 0; i + 2 < posed.primitive->indices.size(); i += 3)
      visit(posed, i, 0.5 * glm::length(area_vector(posed, i)));
  });
}

std::vector<PosedLight> lights_everywhere(const Scene& scene, const Pose& pose, const Box& bounds, uint32_t count,
                                          uint64_t seed) {
  double total = 0;
  for_each_triangle(scene, pose, [&](const PosedPrimitive&, size_t, double area) { total += area; });
  std::vector<PosedLight> lights;
  if (!(total > 0)) return lights;
  Random random(seed);
  const auto spacing = static_cast<float>(std::sqrt(total / count));
  double sum = 0, next = random.uniform() / count * total;
  for_each_triangle(scene, pose, [&](const PosedPrimitive& posed, size_t first_index, double area) {
    sum += area;
    while (area > 0 && next < sum && lights.size() < count) {
      const std::vector<uint32_t>& indices = posed.primitive->indices;
      const double u = std::sqrt(random.uniform()), v = random.uniform();
      const glm::dvec3 point = (1 - u) * glm::dvec3(posed.positions[indices[first_index]]) +
                               u * (1 - v) * glm::dvec3(posed.positions[indices[first_index + 1]]) +
                               u * v * glm::dvec3(posed.positions[indices[first_index + 2]]);
      PosedLight light = make_light(random, lights.size(), random_range(random, spacing, bounds));
      const double height = double(light.range * random.between(kSmallestHeight, kLargestHeight));
      light.position = glm::vec3(point + height * glm::normalize(area_vector(posed, first_index)));
      lights.push_back(std::move(light));
      next = (static_cast<double>(lights.size()) + random.uniform()) / count * total;
    }
  });
  // Rounding may leave the sum short of the last share's sample.
  while (!lights.empty() && lights.size() < count) lights.push_back(lights.back());
  return lights;
}

}  // namespace

umbrage::Result<std::vector<PosedLight>> random_lights(const Scene& scene, const Pose& pose, const Box& bounds,
                                                       uint32_t count, uint64_t seed) {
  if (count == 0) return std::vector<PosedLight>();
  std::vector<VisibilityBuffer> buffers;
  for (const PosedCamera& camera : pose.cameras) buffers.emplace_back(camera);
  if (!buffers.empty()) {
    for_each_primitive(scene, pose, [&](const PosedPrimitive& posed) {
      for (VisibilityBuffer& buffer : buffers) buffer.draw(scene, posed);
    });
  }
  const std::vector<Candidate> candidates = seen_points(buffers);
  if (!candidates.empty()) return lights_in_sight(buffers, candidates, bounds, count, seed);
  std::vector<PosedLight> lights = lights_everywhere(scene, pose, bounds, count, seed);
  if (lights.empty()) return invalid("--random-lights: the scene has no surface to put lights over");
  return lights;
}

}  // namespace app
