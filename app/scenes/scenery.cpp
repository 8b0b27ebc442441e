// The table of models, and nodes for what stands and shines.
#include "scenes/scenery.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scenes/country.hpp"
#include "scenes/house.hpp"
#include "scenes/materials.hpp"
#include "scenes/props.hpp"
#include "scenes/town_plan.hpp"

namespace app {
namespace {

using glm::vec3;

struct Recipe {
  Model model;
  const char* name;
  void (*make)(MeshBuilder&, Detail);
};

constexpr Recipe recipes[] = {
    {Model::street_lamp, "street lamp", add_street_lamp},
    {Model::wall_lamp, "wall lamp", add_wall_lamp},
    {Model::yard_lamp, "yard lamp", add_yard_lamp},
    {Model::bench, "bench", add_bench},
    {Model::barrels, "barrels", add_barrels},
    {Model::crates, "crates", add_crates},
    {Model::cart, "cart", add_cart},
    {Model::well, "well", add_well},
    {Model::firewood, "firewood", add_firewood},
    {Model::stall_red, "red stall", [](MeshBuilder& b, Detail d) { add_market_stall(b, d, Mat::cloth_red); }},
    {Model::stall_blue, "blue stall", [](MeshBuilder& b, Detail d) { add_market_stall(b, d, Mat::cloth_blue); }},
    {Model::fountain, "fountain", add_fountain},
    {Model::laundry, "laundry", add_laundry},
    {Model::picket_fence, "picket fence", add_picket_fence},
    {Model::stone_wall, "stone wall", add_stone_wall},
    {Model::flower_bed, "flower bed", add_flower_bed},
    {Model::gravestone, "gravestone", add_gravestone},
    {Model::planter, "planter", add_planter},
    {Model::oak, "oak", [](MeshBuilder& b, Detail d) { add_broad_tree(b, d, Mat::leaf_green, 8.5f, 71); }},
    {Model::lime, "lime", [](MeshBuilder& b, Detail d) { add_broad_tree(b, d, Mat::leaf_olive, 7.0f, 73); }},
    {Model::maple, "maple", [](MeshBuilder& b, Detail d) { add_broad_tree(b, d, Mat::leaf_autumn, 6.2f, 79); }},
    {Model::spruce, "spruce", [](MeshBuilder& b, Detail d) { add_spruce(b, d, 83); }},
    {Model::poplar, "poplar", [](MeshBuilder& b, Detail d) { add_poplar(b, d, 89); }},
    {Model::bush, "bush", [](MeshBuilder& b, Detail d) { add_bush(b, d, 91); }},
    {Model::church, "church", add_church},
    {Model::fir, "fir", [](MeshBuilder& b, Detail d) { add_fir(b, d, 11, 107); }},
    {Model::tall_fir, "tall fir", [](MeshBuilder& b, Detail d) { add_fir(b, d, 15, 109); }},
    {Model::beech, "beech", [](MeshBuilder& b, Detail d) { add_crown_tree(b, d, Mat::leaf_green, 9, 113); }},
    {Model::birch, "birch", [](MeshBuilder& b, Detail d) { add_crown_tree(b, d, Mat::leaf_gold, 8, 127); }},
    {Model::reeds, "reeds", add_reeds},
    {Model::hay_bale, "hay bale", add_hay_bale},
    {Model::windmill, "windmill", add_windmill},
    {Model::jetty, "jetty", add_jetty},
    {Model::boat, "boat", add_boat},
    {Model::floodlight, "floodlight", add_floodlight},
};

}  // namespace

Scenery::Scenery(Detail detail)
    : detail_(detail), mesh_of_model_(static_cast<size_t>(Model::first_house) + house_styles().size(), -1) {
  add_materials(scene_);
}

int Scenery::mesh_of(Model model) {
  int& mesh = mesh_of_model_[static_cast<size_t>(model)];
  if (mesh >= 0) return mesh;
  mesh = static_cast<int>(scene_.meshes.size());
  if (model >= Model::first_house) {
    const HouseStyle& style = house_styles()[static_cast<size_t>(model) - static_cast<size_t>(Model::first_house)];
    add_house(builder_, style, detail_);
    scene_.meshes.push_back(builder_.take(style.name));
    return mesh;
  }
  for (const Recipe& recipe : recipes) {
    if (recipe.model != model) continue;
    recipe.make(builder_, detail_);
    scene_.meshes.push_back(builder_.take(recipe.name));
  }
  return mesh;
}

void Scenery::stand(const Standing& standing) {
  const int mesh = mesh_of(standing.model);
  Node node{.name = scene_.meshes[static_cast<size_t>(mesh)].name, .translation = standing.position};
  node.rotation = glm::angleAxis(standing.turn, vec3(0, 1, 0));
  node.scale = vec3(standing.scale);
  node.mesh = mesh;
  scene_.nodes.push_back(std::move(node));
}

Node& Scenery::add_single_node(const char* name) {
  scene_.meshes.push_back(builder_.take(name));
  return scene_.nodes.emplace_back(Node{.name = name, .mesh = static_cast<int>(scene_.meshes.size()) - 1});
}

void Scenery::add_light(Light light, vec3 position, vec3 direction) {
  Node node{.name = light.name, .translation = position, .light = static_cast<int>(scene_.lights.size())};
  if (light.kind != LightKind::point) {
    const bool steep = std::abs(direction.y) > 0.99f * glm::length(direction);
    node.rotation = glm::quatLookAt(glm::normalize(direction), steep ? vec3(1, 0, 0) : vec3(0, 1, 0));
  }
  scene_.lights.push_back(std::move(light));
  scene_.nodes.push_back(std::move(node));
}

void Scenery::light_lamp(const Standing& lamp, Random& random, float brightness) {
  stand(lamp);
  const bool street = lamp.model == Model::street_lamp;
  Light light{.name = "lamp " + std::to_string(scene_.lights.size())};
  light.color = glm::mix(vec3(1.0f, 0.62f, 0.28f), vec3(1.0f, 0.80f, 0.54f), random.unit());
  light.intensity = random.range(0.85f, 1.15f) * (street ? 46.0f : 30.0f) * brightness;
  light.range = random.range(-0.6f, 0.6f) + (street ? 13.0f : 10.5f);
  add_light(std::move(light), lamp_light(lamp));
}

}  // namespace app
