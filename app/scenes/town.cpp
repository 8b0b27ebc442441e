// Meshes for the plan's models, nodes for what stands, a light in every chosen lamp.
#include "scenes/town.hpp"

#include "scenes/cameras.hpp"
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
};

void add_models(Scene& scene, Detail detail) {
  MeshBuilder builder;
  scene.meshes.resize(static_cast<size_t>(Model::first_house));
  for (const Recipe& recipe : recipes) {
    recipe.make(builder, detail);
    scene.meshes[static_cast<size_t>(recipe.model)] = builder.take(recipe.name);
  }
  for (const HouseStyle& style : house_styles()) {
    add_house(builder, style, detail);
    scene.meshes.push_back(builder.take(style.name));
  }
}

void add_single(Scene& scene, MeshBuilder& builder, const char* name) {
  scene.meshes.push_back(builder.take(name));
  scene.nodes.push_back({.name = name, .mesh = static_cast<int>(scene.meshes.size()) - 1});
}

void add_standing(Scene& scene, const Standing& standing) {
  Node node{.name = scene.meshes[static_cast<size_t>(standing.model)].name, .translation = standing.position};
  node.rotation = glm::angleAxis(standing.turn, vec3(0, 1, 0));
  node.scale = vec3(standing.scale);
  node.mesh = static_cast<int>(standing.model);
  scene.nodes.push_back(std::move(node));
}

/// Gas and oil: warm, each a little different.
void add_lamp(Scene& scene, const Standing& lamp, Random& random) {
  add_standing(scene, lamp);
  const bool street = lamp.model == Model::street_lamp;
  Light light{.name = "lamp " + std::to_string(scene.lights.size())};
  light.color = glm::mix(vec3(1.0f, 0.62f, 0.28f), vec3(1.0f, 0.80f, 0.54f), random.unit());
  light.intensity = random.range(0.85f, 1.15f) * (street ? 46.0f : 30.0f);
  light.range = random.range(-0.6f, 0.6f) + (street ? 13.0f : 10.5f);
  Node node{.name = light.name, .translation = lamp_light(lamp), .light = static_cast<int>(scene.lights.size())};
  scene.lights.push_back(std::move(light));
  scene.nodes.push_back(std::move(node));
}

}  // namespace

Scene make_town(Detail detail) {
  Scene scene;
  add_materials(scene);
  add_models(scene, detail);
  const Terrain terrain;
  const TownPlan plan = plan_town(terrain);
  MeshBuilder builder;
  terrain.build(builder, detail);
  add_single(scene, builder, "ground");
  add_sky(builder, detail);
  add_single(scene, builder, "sky");
  for (const Standing& standing : plan.standing) add_standing(scene, standing);
  Random random(256);
  for (const Standing& lamp : choose_lamps(plan, town_light_count)) add_lamp(scene, lamp, random);
  add_cameras(scene, terrain);
  return scene;
}

}  // namespace app
