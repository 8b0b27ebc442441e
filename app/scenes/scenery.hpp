// A scene in the making, from models that become meshes when one first stands somewhere.
#pragma once
#include <vector>

#include "import/scene.hpp"
#include "scenes/mesh_builder.hpp"
#include "scenes/random.hpp"
#include "scenes/standing.hpp"

namespace app {

class Scenery {
 public:
  explicit Scenery(Detail detail);
  Detail detail() const { return detail_; }
  Scene& scene() { return scene_; }

  void stand(const Standing& standing);
  /// What `make` builds, once and where it is built.
  template <class Make>
  Node& add_single(const char* name, Make make) {
    make(builder_);
    return add_single_node(name);
  }
  /// The lamp's model and `light` in its lantern. Colour, intensity and range are those of gas and oil, each lamp a
  /// little different: warm, and wider and brighter in streets. `brightness` multiplies the intensity.
  void light_lamp(const Standing& lamp, Random& random, float brightness = 1);
  void add_light(Light light, glm::vec3 position, glm::vec3 direction = {0, -1, 0});

  Scene take() { return std::move(scene_); }

 private:
  int mesh_of(Model model);
  Node& add_single_node(const char* name);

  Detail detail_;
  Scene scene_;
  MeshBuilder builder_;
  std::vector<int> mesh_of_model_;  ///< -1: not made yet.
};

}  // namespace app
