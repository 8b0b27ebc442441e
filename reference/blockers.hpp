// The posed scene as Embree holds it: one scene of triangles per mesh, shared by its rigid instances.
#pragma once
#include <deque>
#include <memory>
#include <vector>

#include "reference/embree.hpp"
#include "umbrage/result.hpp"

namespace reference {

/// What a hit needs to know of the primitive it is on; every Embree geometry points at one.
struct Surface {
  const app::Primitive* primitive = nullptr;
  const app::Material* material = nullptr;
  const app::Image* image = nullptr;  ///< Of the base colour, for masked materials only.
};

class Blockers {
 public:
  /// Errors: invalid_argument (indices of the scene that lead nowhere, transforms that are not finite), out_of_memory.
  static umbrage::Result<Blockers> build(const TracerInput&);

  /// Hits carry instID = index into Pose::instances and geomID = index into the mesh's primitives.
  RTCScene scene() const { return top_.get(); }
  float diagonal() const { return diagonal_; }
  /// Object-space normals → world, not normalised. Identity where the triangles are held in world space.
  const glm::mat3& normal_transform(uint32_t instance) const { return normal_transforms_[instance]; }

 private:
  Blockers() = default;
  umbrage::Result<void> add_instances(const TracerInput&);
  umbrage::Result<void> add_surfaces(const app::Scene&);
  umbrage::Result<void> attach(uint32_t instance, RTCScene child, const glm::mat4& transform);
  umbrage::Result<void> finish();
  umbrage::Result<void> check(const char* step) const;
  embree::Scene mesh_scene(const app::Mesh&, const std::vector<Surface>&,
                           const std::vector<const std::vector<glm::vec3>*>& positions) const;

  embree::Device device_;
  std::deque<std::vector<Surface>> surfaces_;  ///< By mesh; Embree's geometries point into it.
  std::vector<embree::Scene> children_;
  std::vector<glm::mat3> normal_transforms_;
  embree::Scene top_;
  float diagonal_ = 0;
};

}  // namespace reference
