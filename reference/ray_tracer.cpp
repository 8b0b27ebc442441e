// Queries against Blockers, and the module's one symbol.
#include "reference/ray_tracer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <exception>

#include "reference/blockers.hpp"
#include "reference/parallel_rows.hpp"

namespace reference {
namespace {

constexpr float start_offset = 1e-5f;  // of the numbers' size, along the normal
constexpr uint32_t packet_size = 8;

/// Depth of a point as the light's views measure it: the cube face or the one view that shows it.
float axis_depth(const Light& light, glm::vec3 position) {
  const glm::vec3 offset = position - light.position;
  if (!drawn_as_cube(light)) return glm::dot(offset, light.direction);
  const glm::vec3 size = glm::abs(offset);
  return std::max({size.x, size.y, size.z});
}

/// From a receiver to the near plane of the light. `far` is 0 where nothing lies between.
Ray shadow_ray(const Light& light, glm::vec3 start) {
  if (light.kind == app::LightKind::directional) return {start, -light.direction};
  const float depth = axis_depth(light, start);
  return {start, light.position - start, 0, depth > light.near ? 1 - light.near / depth : 0};
}

/// How far rays start from their surface. Positions are as wrong as their coordinates are large, so that these decide; in a
/// picture of one corner of a large scene the scene's diagonal would lift grazing rays over what stands in their way.
float offset_of(const SurfaceImage& image, const Light& light, float diagonal) {
  float largest = 0;
  for (const float coordinate : image.positions)
    largest = std::max(largest, std::isnan(coordinate) ? 0 : std::abs(coordinate));
  if (light.kind != app::LightKind::directional)
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(light.position[axis]));
  return start_offset * (largest > 0 ? std::min(largest, diagonal) : diagonal);
}

/// Eight shadow rays in Embree's layout with the pixels they belong to.
class ShadowPacket {
 public:
  ShadowPacket(RTCScene scene, std::span<uint8_t> result) : result_(result), scene_(scene) {}

  void add(const Ray& ray, size_t pixel) {
    const uint32_t i = count_++;
    rays_.org_x[i] = ray.origin.x, rays_.org_y[i] = ray.origin.y, rays_.org_z[i] = ray.origin.z;
    rays_.dir_x[i] = ray.direction.x, rays_.dir_y[i] = ray.direction.y, rays_.dir_z[i] = ray.direction.z;
    rays_.tnear[i] = ray.near, rays_.tfar[i] = ray.far;
    rays_.time[i] = 0, rays_.mask[i] = ~0u, rays_.id[i] = i, rays_.flags[i] = 0;
    pixels_[i] = pixel;
    if (count_ == packet_size) trace();
  }

  void trace() {
    if (count_ == 0) return;
    alignas(32) int valid[packet_size];
    for (uint32_t i = 0; i < packet_size; ++i) valid[i] = i < count_ ? -1 : 0;
    embree::Query query(Faces::both);
    embree::occluded(valid, scene_, query, rays_);
    // Embree marks what is occluded by tfar = -infinity.
    for (uint32_t i = 0; i < count_; ++i) result_[pixels_[i]] = rays_.tfar[i] < 0 ? blocked : visible;
    count_ = 0;
  }

 private:
  RTCRay8 rays_{};
  size_t pixels_[packet_size] = {};
  std::span<uint8_t> result_;
  RTCScene scene_;
  uint32_t count_ = 0;
};

class EmbreeTracer final : public RayTracer {
 public:
  explicit EmbreeTracer(Blockers blockers) : blockers_(std::move(blockers)) {}

  float diagonal() const override { return blockers_.diagonal(); }

  void visibility(const Light& light, const SurfaceImage& image, std::span<const uint8_t> evaluated,
                  std::span<uint8_t> result) const override {
    [[maybe_unused]] const size_t pixels = size_t(image.width) * image.height;
    assert(image.positions.size() == 3 * pixels && image.normals.size() == 3 * pixels);
    assert(evaluated.size() == pixels && result.size() == pixels);
    std::fill(result.begin(), result.end(), not_evaluated);
    const float offset = offset_of(image, light, blockers_.diagonal());
    parallel_rows(image.height, [&](uint32_t y) { trace_row(light, image, offset, y, evaluated, result); });
  }

  void closest_hits(std::span<const Ray> rays, Faces faces, std::span<Hit> hits) const override {
    assert(hits.size() == rays.size());
    constexpr size_t rays_a_row = 1024;
    parallel_rows(uint32_t((rays.size() + rays_a_row - 1) / rays_a_row), [&](uint32_t row) {
      const size_t first = row * rays_a_row, last = std::min(first + rays_a_row, rays.size());
      for (size_t i = first; i < last; ++i) hits[i] = closest_hit(rays[i], faces);
    });
  }

 private:
  void trace_row(const Light& light, const SurfaceImage& image, float offset, uint32_t y,
                 std::span<const uint8_t> evaluated, std::span<uint8_t> result) const {
    ShadowPacket packet(blockers_.scene(), result);
    for (uint32_t x = 0; x < image.width; ++x) {
      const size_t pixel = size_t(y) * image.width + x;
      const float* position = &image.positions[3 * pixel];
      if (evaluated[pixel] == not_evaluated || std::isnan(position[0])) continue;
      const float* normal = &image.normals[3 * pixel];
      const glm::vec3 start =
          glm::vec3(position[0], position[1], position[2]) + glm::vec3(normal[0], normal[1], normal[2]) * offset;
      const Ray ray = shadow_ray(light, start);
      if (ray.far > 0) {
        packet.add(ray, pixel);
      } else {
        result[pixel] = visible;
      }
    }
    packet.trace();
  }

  Hit closest_hit(const Ray& ray, Faces faces) const {
    RTCRayHit query_ray{};
    query_ray.ray.org_x = ray.origin.x, query_ray.ray.org_y = ray.origin.y, query_ray.ray.org_z = ray.origin.z;
    query_ray.ray.dir_x = ray.direction.x, query_ray.ray.dir_y = ray.direction.y, query_ray.ray.dir_z = ray.direction.z;
    query_ray.ray.tnear = ray.near, query_ray.ray.tfar = ray.far;
    query_ray.ray.mask = ~0u;
    query_ray.hit.geomID = query_ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::Query query(faces);
    embree::intersect(blockers_.scene(), query, query_ray);
    if (query_ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};

    Hit hit{.distance = query_ray.ray.tfar,
            .instance = query_ray.hit.instID[0],
            .primitive = query_ray.hit.geomID,
            .triangle = query_ray.hit.primID};
    hit.position = ray.origin + ray.direction * hit.distance;
    const glm::vec3 object_normal(query_ray.hit.Ng_x, query_ray.hit.Ng_y, query_ray.hit.Ng_z);
    hit.normal = glm::normalize(blockers_.normal_transform(hit.instance) * object_normal);
    if (glm::dot(hit.normal, ray.direction) > 0) hit.normal = -hit.normal;
    return hit;
  }

  Blockers blockers_;
};

RayTracer* fail(char* error, size_t error_size, const char* message) {
  std::snprintf(error, error_size, "%s", message);
  return nullptr;
}

}  // namespace
}  // namespace reference

extern "C" __attribute__((visibility("default"))) reference::RayTracer* umbrage_reference_create(
    uint32_t interface_version, const reference::TracerInput& input, char* error, size_t error_size) {
  using namespace reference;
  if (interface_version != tracer_interface_version) {
    return fail(error, error_size,
                "ray tracer: program and libumbrage_reference.so are of different builds: build both again");
  }
  try {
    auto blockers = Blockers::build(input);
    if (!blockers) return fail(error, error_size, blockers.error().message.c_str());
    return new EmbreeTracer(std::move(blockers).value());
  } catch (const std::exception& exception) {
    return fail(error, error_size, (std::string("ray tracer: ") + exception.what()).c_str());
  }
}

static_assert(std::is_same_v<decltype(&umbrage_reference_create), reference::CreateRayTracer>);
