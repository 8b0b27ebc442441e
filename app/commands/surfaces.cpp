// The posed scene's triangles in the world.
#include "commands/surfaces.hpp"

#include <vector>

namespace app {

void for_each_primitive(const Scene& scene, const Pose& pose, const std::function<void(const PosedPrimitive&)>& visit) {
  std::vector<glm::vec3> world;
  for (const PosedInstance& instance : pose.instances) {
    const bool is_deformed = instance.skin >= 0 || !instance.weights.empty();
    for (const Primitive& primitive : scene.meshes[instance.mesh].primitives) {
      world = is_deformed ? deformed_positions(primitive, instance, pose) : primitive.positions;
      for (glm::vec3& position : world) position = glm::vec3(instance.world_from_mesh * glm::vec4(position, 1));
      visit({&primitive, world});
    }
  }
}

Box scene_bounds(const Scene& scene, const Pose& pose) {
  Box bounds;
  for_each_primitive(scene, pose, [&](const PosedPrimitive& posed) {
    // Through the indices: primitives often share one buffer of vertices, most of which are not theirs.
    for (const uint32_t index : posed.primitive->indices) bounds.extend(posed.positions[index]);
  });
  return bounds;
}

}  // namespace app
