// The table of materials.
#include "scenes/materials.hpp"

#include "scenes/textures.hpp"

namespace app {
namespace {

using glm::vec3;

struct Images {
  int albedo = -1, normal = -1;
  float metres = 1;
};

Images add_surface(Scene& scene, Surface surface, float metres) {
  const int first = static_cast<int>(scene.images.size());
  scene.images.push_back(std::move(surface.albedo));
  scene.images.push_back(std::move(surface.normal));
  return {first, first + 1, metres};
}

class Table {
 public:
  explicit Table(Scene& scene) : materials_(scene.materials) { materials_.resize(static_cast<size_t>(Mat::count)); }

  Material& set(Mat mat, const char* name, vec3 color, float roughness, const Images& images = {}) {
    Material& material = materials_[static_cast<size_t>(mat)];
    material.name = name;
    material.base_color = glm::vec4(color, 1);
    material.metallic = 0;
    material.roughness = roughness;
    const glm::mat3x2 from_metres(1 / images.metres, 0, 0, 1 / images.metres, 0, 0);
    material.base_color_texture.image = images.albedo;
    material.normal_texture.image = images.normal;
    material.base_color_texture.uv_transform = material.normal_texture.uv_transform = from_metres;
    return material;
  }

 private:
  std::vector<Material>& materials_;
};

void set_walls_and_ground(Scene& scene, Table& table) {
  const Images plaster = add_surface(scene, make_plaster(), 2), masonry = add_surface(scene, make_masonry(), 2);
  const Images flags = add_surface(scene, make_flagstones(), 2), cobbles = add_surface(scene, make_cobbles(), 2);
  const Images grass = add_surface(scene, make_grass(), 4), clay = add_surface(scene, make_clay(), 2);
  table.set(Mat::plaster_cream, "cream plaster", {0.78f, 0.66f, 0.45f}, 0.9f, plaster);
  table.set(Mat::plaster_ochre, "ochre plaster", {0.80f, 0.55f, 0.26f}, 0.9f, plaster);
  table.set(Mat::plaster_rose, "rose plaster", {0.78f, 0.48f, 0.38f}, 0.9f, plaster);
  table.set(Mat::plaster_blue, "blue plaster", {0.48f, 0.60f, 0.68f}, 0.9f, plaster);
  table.set(Mat::plaster_white, "white plaster", {0.80f, 0.76f, 0.68f}, 0.9f, plaster);
  table.set(Mat::plaster_sage, "sage plaster", {0.58f, 0.64f, 0.46f}, 0.9f, plaster);
  table.set(Mat::stone, "rubble stone", {0.60f, 0.56f, 0.50f}, 0.9f, masonry);
  table.set(Mat::trim, "dressed stone", {0.58f, 0.54f, 0.47f}, 0.8f, plaster);
  table.set(Mat::flagstone, "flagstones", {0.44f, 0.42f, 0.39f}, 0.75f, flags);
  table.set(Mat::cobble, "cobbles", {0.40f, 0.385f, 0.37f}, 0.5f, cobbles);
  table.set(Mat::grass, "grass", {0.30f, 0.37f, 0.16f}, 1.0f, grass);
  table.set(Mat::earth, "earth", {0.34f, 0.25f, 0.16f}, 1.0f, plaster);
  const Images rows = add_surface(scene, make_rows(), 4);
  table.set(Mat::gravel, "gravel", {0.50f, 0.44f, 0.36f}, 0.95f, plaster);
  table.set(Mat::sand, "sand", {0.55f, 0.46f, 0.33f}, 0.95f, plaster);
  table.set(Mat::forest_floor, "forest floor", {0.17f, 0.16f, 0.08f}, 1.0f, grass);
  table.set(Mat::wheat, "wheat", {0.78f, 0.56f, 0.20f}, 1.0f, rows);
  table.set(Mat::stubble, "stubble", {0.70f, 0.58f, 0.31f}, 1.0f, rows);
  table.set(Mat::plough, "ploughed earth", {0.32f, 0.21f, 0.14f}, 1.0f, rows);
  table.set(Mat::lake, "lake", {0.02f, 0.04f, 0.05f}, 0.16f, add_surface(scene, make_ripples(), 12));
  table.set(Mat::roof_red, "red tiles", {0.62f, 0.24f, 0.14f}, 0.75f, clay);
  table.set(Mat::roof_brown, "brown tiles", {0.42f, 0.24f, 0.15f}, 0.75f, clay);
  table.set(Mat::roof_slate, "slates", {0.27f, 0.30f, 0.35f}, 0.55f, clay);
}

void set_wood(Scene& scene, Table& table) {
  const Images wood = add_surface(scene, make_wood(), 1);
  table.set(Mat::timber, "dark timber", {0.20f, 0.13f, 0.08f}, 0.8f, wood);
  table.set(Mat::plank, "planks", {0.52f, 0.37f, 0.22f}, 0.8f, wood);
  table.set(Mat::paint_green, "green paint", {0.14f, 0.32f, 0.20f}, 0.55f, wood);
  table.set(Mat::paint_red, "red paint", {0.46f, 0.10f, 0.07f}, 0.55f, wood);
  table.set(Mat::paint_blue, "blue paint", {0.13f, 0.25f, 0.40f}, 0.55f, wood);
  table.set(Mat::paint_white, "white paint", {0.82f, 0.79f, 0.72f}, 0.6f, wood);
  table.set(Mat::bark, "bark", {0.30f, 0.23f, 0.16f}, 0.95f, wood);
}

void set_plants_and_cloth(Table& table) {
  const auto leaf = [&](Mat mat, const char* name, vec3 color) {
    table.set(mat, name, color, 0.7f).double_sided = true;
  };
  leaf(Mat::leaf_green, "green leaves", {0.16f, 0.30f, 0.07f});
  leaf(Mat::leaf_olive, "olive leaves", {0.30f, 0.36f, 0.12f});
  leaf(Mat::leaf_autumn, "autumn leaves", {0.58f, 0.28f, 0.06f});
  leaf(Mat::leaf_dark, "needles", {0.07f, 0.17f, 0.09f});
  leaf(Mat::leaf_gold, "golden leaves", {0.50f, 0.38f, 0.09f});
  leaf(Mat::leaf_fir, "fir needles", {0.11f, 0.15f, 0.05f});
  leaf(Mat::petal_red, "red petals", {0.70f, 0.06f, 0.09f});
  leaf(Mat::petal_yellow, "yellow petals", {0.85f, 0.62f, 0.08f});
  leaf(Mat::straw, "straw", {0.66f, 0.50f, 0.21f});
  leaf(Mat::cloth_white, "white cloth", {0.84f, 0.82f, 0.78f});
  leaf(Mat::cloth_red, "red cloth", {0.60f, 0.09f, 0.07f});
  leaf(Mat::cloth_blue, "blue cloth", {0.16f, 0.26f, 0.50f});
  table.set(Mat::fruit_orange, "oranges", {0.85f, 0.36f, 0.05f}, 0.5f);
  table.set(Mat::fruit_green, "apples", {0.45f, 0.55f, 0.10f}, 0.4f);
}

void set_shining(Scene& scene, Table& table) {
  table.set(Mat::iron, "iron", {0.10f, 0.10f, 0.11f}, 0.5f).metallic = 0.5f;
  table.set(Mat::gold, "gilding", {0.90f, 0.65f, 0.25f}, 0.35f).metallic = 1;
  table.set(Mat::glass, "dark glass", {0.03f, 0.04f, 0.05f}, 0.12f);
  table.set(Mat::water, "water", {0.05f, 0.09f, 0.10f}, 0.08f);
  const auto shine = [&](Mat mat, const char* name, vec3 emissive, int image) {
    Material& material = table.set(mat, name, vec3(0), 1);
    material.emissive = emissive;
    material.emissive_texture.image = image;
  };
  const int pane = static_cast<int>(scene.images.size());
  scene.images.push_back(make_window_glow());
  scene.images.push_back(make_sky());
  shine(Mat::window_bright, "lit window", vec3(5.0f, 3.9f, 2.4f), pane);
  shine(Mat::window_warm, "dim window", vec3(2.4f, 1.4f, 0.65f), pane);
  shine(Mat::glow, "lamp mantle", vec3(42, 27, 12), -1);
  shine(Mat::dial, "clock face", vec3(2.2f, 1.7f, 1.0f), -1);
  shine(Mat::sky, "sky", vec3(0.16f), pane + 1);
  scene.materials[static_cast<size_t>(Mat::sky)].emissive_texture.wrap_v = Wrap::clamp;
  scene.materials[static_cast<size_t>(Mat::sky)].casts_shadow = false;
}

}  // namespace

void add_materials(Scene& scene) {
  Table table(scene);
  set_walls_and_ground(scene, table);
  set_wood(scene, table);
  set_plants_and_cloth(table);
  set_shining(scene, table);
}

}  // namespace app
