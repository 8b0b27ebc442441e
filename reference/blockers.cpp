#include "reference/blockers.hpp"

#include <cmath>
#include <cstring>
#include <map>
#include <string>

#include "reference/alpha.hpp"

namespace reference {
namespace {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;
using Positions = std::vector<const std::vector<glm::vec3>*>;

bool passes_mask(const Surface& surface, const RTCFilterFunctionNArguments& hits, unsigned i) {
  if (surface.material->alpha_mode != app::AlphaMode::mask) return true;
  const float alpha =
      surface_alpha(*surface.primitive, *surface.material, surface.image, RTCHitN_primID(hits.hit, hits.N, i),
                    RTCHitN_u(hits.hit, hits.N, i), RTCHitN_v(hits.hit, hits.N, i));
  return alpha >= surface.material->alpha_cutoff;
}

bool faces_ray(const RTCFilterFunctionNArguments& hits, unsigned i) {
  const glm::vec3 normal(RTCHitN_Ng_x(hits.hit, hits.N, i), RTCHitN_Ng_y(hits.hit, hits.N, i),
                         RTCHitN_Ng_z(hits.hit, hits.N, i));
  const glm::vec3 direction(RTCRayN_dir_x(hits.ray, hits.N, i), RTCRayN_dir_y(hits.ray, hits.N, i),
                            RTCRayN_dir_z(hits.ray, hits.N, i));
  return glm::dot(normal, direction) < 0;
}

/// Shadow rays: drops hits on the holes of masked materials.
void filter_occluded(const RTCFilterFunctionNArguments* hits) {
  const auto& surface = *static_cast<const Surface*>(hits->geometryUserPtr);
  for (unsigned i = 0; i < hits->N; ++i) {
    if (hits->valid[i] == -1 && !passes_mask(surface, *hits, i)) hits->valid[i] = 0;
  }
}

/// Closest hits: the same, and back faces of single-sided materials where the query wants what a camera sees. Ray and
/// normal are both in object space, so that a mirroring transform keeps glTF's front the front.
void filter_closest(const RTCFilterFunctionNArguments* hits) {
  const auto& surface = *static_cast<const Surface*>(hits->geometryUserPtr);
  const auto& query = *reinterpret_cast<const embree::Query*>(hits->context);
  const bool culls = query.faces == Faces::as_drawn && !surface.material->double_sided;
  for (unsigned i = 0; i < hits->N; ++i) {
    if (hits->valid[i] == -1 && ((culls && !faces_ray(*hits, i)) || !passes_mask(surface, *hits, i))) {
      hits->valid[i] = 0;
    }
  }
}

embree::Geometry make_triangles(RTCDevice device, const std::vector<glm::vec3>& positions, const Surface& surface) {
  const std::vector<uint32_t>& indices = surface.primitive->indices;
  embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  void* vertices = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), positions.size());
  void* corners = rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(uint32_t), indices.size() / 3);
  if (!vertices || !corners) return {};
  std::memcpy(vertices, positions.data(), positions.size() * sizeof(glm::vec3));
  std::memcpy(corners, indices.data(), indices.size() / 3 * 3 * sizeof(uint32_t));
  rtcSetGeometryUserData(geometry.get(), const_cast<Surface*>(&surface));
  const bool masked = surface.material->alpha_mode == app::AlphaMode::mask;
  if (masked) rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_occluded);
  if (masked || !surface.material->double_sided) {
    rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_closest);
  }
  rtcCommitGeometry(geometry.get());
  return geometry;
}

bool finite(const glm::mat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(matrix[column][row])) return false;
    }
  }
  return true;
}

/// A transform that flattens or nearly flattens has no inverse to bring rays into the mesh's space with.
bool invertible(const glm::mat4& matrix) {
  const glm::mat3 linear(matrix);
  const float volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  return std::abs(glm::determinant(linear)) > 1e-5f * volume && volume > 1e-30f;
}

std::vector<glm::vec3> transformed(const std::vector<glm::vec3>& positions, const glm::mat4& transform) {
  std::vector<glm::vec3> result(positions.size());
  for (size_t i = 0; i < positions.size(); ++i) result[i] = glm::vec3(transform * glm::vec4(positions[i], 1));
  return result;
}

Error bad_scene(const std::string& what) {
  return {ErrorCode::invalid_argument, "ray tracer: " + what + ": the scene was changed after it was checked"};
}

}  // namespace

Result<Blockers> Blockers::build(const TracerInput& input) {
  Blockers result;
  result.device_.reset(rtcNewDevice(nullptr));
  if (!result.device_) {
    return Error{ErrorCode::unsupported,
                 "ray tracer: Embree does not start on this processor (it needs SSE2 or NEON): compare elsewhere"};
  }
  if (auto done = result.add_surfaces(*input.scene); !done) return done.error();
  result.top_.reset(rtcNewScene(result.device_.get()));
  rtcSetSceneFlags(result.top_.get(), RTC_SCENE_FLAG_ROBUST);
  if (auto done = result.add_instances(input); !done) return done.error();
  if (auto done = result.finish(); !done) return done.error();
  return result;
}

Result<void> Blockers::add_surfaces(const app::Scene& scene) {
  for (const app::Mesh& mesh : scene.meshes) {
    std::vector<Surface>& surfaces = surfaces_.emplace_back();
    for (const app::Primitive& primitive : mesh.primitives) {
      if (primitive.material >= scene.materials.size()) return bad_scene("mesh '" + mesh.name + "' names no material");
      for (const uint32_t index : primitive.indices) {
        if (index >= primitive.positions.size()) return bad_scene("mesh '" + mesh.name + "' has an index out of range");
      }
      const app::Material& material = scene.materials[primitive.material];
      const app::Image* image = nullptr;
      if (const int index = material.base_color_texture.image;
          material.alpha_mode == app::AlphaMode::mask && index >= 0) {
        if (size_t(index) >= scene.images.size()) return bad_scene("material '" + material.name + "' names no image");
        image = &scene.images[size_t(index)];
        if (image->rgba.size() != size_t(4) * image->width * image->height) {
          return bad_scene("image '" + image->name + "' has fewer or more bytes than pixels");
        }
        if (image->rgba.empty()) image = nullptr;
      }
      surfaces.push_back({&primitive, &material, image});
    }
  }
  return {};
}

embree::Scene Blockers::mesh_scene(const app::Mesh& mesh, const std::vector<Surface>& surfaces,
                                   const Positions& positions) const {
  embree::Scene scene(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  for (uint32_t i = 0; i < mesh.primitives.size(); ++i) {
    const app::Material& material = *surfaces[i].material;
    if (!material.casts_shadow || material.alpha_mode == app::AlphaMode::blend || mesh.primitives[i].indices.size() < 3)
      continue;
    if (const embree::Geometry geometry = make_triangles(device_.get(), *positions[i], surfaces[i])) {
      rtcAttachGeometryByID(scene.get(), geometry.get(), i);
    }
  }
  rtcCommitScene(scene.get());
  return scene;
}

Result<void> Blockers::add_instances(const TracerInput& input) {
  std::map<std::pair<uint32_t, uint32_t>, const std::vector<glm::vec3>*> deformed;
  for (const DeformedPrimitive& d : input.deformed) deformed[{d.instance, d.primitive}] = &d.positions;
  std::vector<RTCScene> shared(input.scene->meshes.size(), nullptr);

  for (uint32_t i = 0; i < input.pose->instances.size(); ++i) {
    const app::PosedInstance& instance = input.pose->instances[i];
    if (instance.mesh >= input.scene->meshes.size()) return bad_scene("instance " + std::to_string(i) + " has no mesh");
    if (!finite(instance.world_from_mesh)) {
      return bad_scene("instance " + std::to_string(i) + " has a transform that is not finite");
    }
    const app::Mesh& mesh = input.scene->meshes[instance.mesh];
    const bool flattened = !invertible(instance.world_from_mesh);
    bool own = flattened;
    Positions positions;
    std::vector<std::vector<glm::vec3>> in_world(mesh.primitives.size());
    for (uint32_t p = 0; p < mesh.primitives.size(); ++p) {
      const auto found = deformed.find({i, p});
      positions.push_back(found == deformed.end() ? &mesh.primitives[p].positions : found->second);
      own = own || found != deformed.end();
      if (positions[p]->size() != mesh.primitives[p].positions.size()) {
        return bad_scene("instance " + std::to_string(i) + " has deformed positions of another count");
      }
      if (flattened) {
        in_world[p] = transformed(*positions[p], instance.world_from_mesh);
        positions[p] = &in_world[p];
      }
    }
    RTCScene child = own ? nullptr : shared[instance.mesh];
    if (!child) {
      children_.push_back(mesh_scene(mesh, surfaces_[instance.mesh], positions));
      child = children_.back().get();
      if (!own) shared[instance.mesh] = child;
    }
    if (auto done = attach(i, child, flattened ? glm::mat4(1) : instance.world_from_mesh); !done) return done;
  }
  return {};
}

Result<void> Blockers::attach(uint32_t instance, RTCScene child, const glm::mat4& transform) {
  const embree::Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(geometry.get(), child);
  rtcSetGeometryTimeStepCount(geometry.get(), 1);
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &transform);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(top_.get(), geometry.get(), instance);
  normal_transforms_.push_back(glm::transpose(glm::inverse(glm::mat3(transform))));
  return check("an instance");
}

Result<void> Blockers::finish() {
  rtcCommitScene(top_.get());
  RTCBounds bounds;
  rtcGetSceneBounds(top_.get(), &bounds);
  const glm::vec3 size(bounds.upper_x - bounds.lower_x, bounds.upper_y - bounds.lower_y,
                       bounds.upper_z - bounds.lower_z);
  const float length = glm::length(size);
  diagonal_ = size.x >= 0 && std::isfinite(length) ? length : 0;
  return check("the scene");
}

Result<void> Blockers::check(const char* step) const {
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error == RTC_ERROR_NONE) return {};
  if (error == RTC_ERROR_OUT_OF_MEMORY) {
    return Error{ErrorCode::out_of_memory, std::string("ray tracer: not enough memory for ") + step};
  }
  return Error{ErrorCode::invalid_argument,
               std::string("ray tracer: Embree refused ") + step + " with error " + std::to_string(int(error))};
}

}  // namespace reference
