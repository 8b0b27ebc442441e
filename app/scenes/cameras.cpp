// Views into cameras and their nodes.
#include "scenes/cameras.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace app {

void add_cameras(Scene& scene, const Terrain& terrain, std::span<const View> views) {
  for (const View& view : views) {
    const glm::vec3 eye{view.eye.x, terrain.ground(view.eye) + view.eye_height, view.eye.y};
    const glm::vec3 target{view.target.x, terrain.ground(view.target) + view.target_height, view.target.y};
    Node node{.name = view.name, .translation = eye, .camera = static_cast<int>(scene.cameras.size())};
    node.rotation = glm::quat_cast(glm::inverse(glm::mat3(glm::lookAt(eye, target, glm::vec3(0, 1, 0)))));
    scene.cameras.push_back({.name = view.name, .fov_y = glm::radians(view.fov_y_deg)});
    scene.nodes.push_back(std::move(node));
  }
}

}  // namespace app
