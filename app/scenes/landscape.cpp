// Town and country on one ground, with their lamps, under one sun.
#include "scenes/landscape.hpp"

#include <array>
#include <cmath>

#include "scenes/cameras.hpp"
#include "scenes/country.hpp"
#include "scenes/country_plan.hpp"
#include "scenes/land.hpp"
#include "scenes/props.hpp"
#include "scenes/random.hpp"
#include "scenes/scenery.hpp"
#include "scenes/sky.hpp"
#include "scenes/textures.hpp"
#include "scenes/town_plan.hpp"

namespace app {
namespace {

using glm::vec3;

/// Street lamps that are to be seen while the sun still shines are brighter than those of the night.
constexpr float street_lamp_scale = 1.7f;
/// Where the sun stands: west of north, and over the horizon.
constexpr float sun_azimuth = 1.0f, sun_height = 0.20f;
constexpr SkyDome sky_dome{.radius_m = 1400, .bottom_m = -150, .rise_m = 1000};

/// Over the town and its lake from the south; along the main street with the sun behind; over the lake towards the sun.
constexpr View views[] = {
    {"overview", {62, 124}, 25.0f, {-20, 0}, 0.0f, 50},
    {"street", {-54, 2.6f}, 2.3f, {0, 3}, 4.0f, 56},
    {"quay", {-60, 9.5f}, 2.8f, {-120, -22}, 4.5f, 56},
};

vec3 to_sun() {
  return {-std::sin(sun_azimuth) * std::cos(sun_height), std::sin(sun_height),
          -std::cos(sun_azimuth) * std::cos(sun_height)};
}

void set_evening(Scene& scene) {
  Material& sky = scene.materials[static_cast<size_t>(Mat::sky)];
  scene.images[static_cast<size_t>(sky.emissive_texture.image)] = make_evening_sky();
  sky.emissive = vec3(1.9f);
  // The renderer mirrors lights alone: what the water shows of the sky shines from it.
  Material& lake = scene.materials[static_cast<size_t>(Mat::lake)];
  lake.emissive = vec3(0.36f);
  lake.emissive_texture.image = static_cast<int>(scene.images.size());
  lake.emissive_texture.wrap_u = lake.emissive_texture.wrap_v = Wrap::clamp;
  // Once over the whole lake, from the west.
  const glm::vec2 scale = 1.0f / (lake_high - lake_low), offset = -lake_low * scale;
  lake.emissive_texture.uv_transform = glm::mat3x2(scale.x, 0, 0, scale.y, offset.x, offset.y);
  scene.images.push_back(make_lake_glow());
}

Light sun() {
  return {.name = "sun", .kind = LightKind::directional, .color = {1.0f, 0.66f, 0.40f}, .intensity = 3.6f};
}

/// Shaded street lamps shine downwards alone.
void light_road_lamp(Scenery& scenery, const Standing& lamp, Random& random) {
  scenery.stand(lamp);
  Light light{.name = "road lamp " + std::to_string(scenery.scene().lights.size()), .kind = LightKind::spot};
  light.color = glm::mix(vec3(1.0f, 0.66f, 0.34f), vec3(1.0f, 0.80f, 0.54f), random.unit());
  light.intensity = random.range(0.9f, 1.1f) * 85.0f;
  light.range = 14;
  light.inner_cone = 0.75f;
  light.outer_cone = 1.25f;
  scenery.add_light(std::move(light), lamp_light(lamp));
}

/// From the corners of the church up its tower.
void add_floodlights(Scenery& scenery, const Terrain& terrain) {
  const vec3 tower{0, 17, -21.5f};
  for (glm::vec2 at : {glm::vec2(-11, -13), {11, -13}, {-13, -31}, {13, -31}}) {
    const vec3 foot{at.x, terrain.ground(at), at.y};
    scenery.stand({Model::floodlight, foot, 0, 1});
    Light light{.name = "floodlight " + std::to_string(scenery.scene().lights.size()), .kind = LightKind::spot};
    light.color = {1.0f, 0.84f, 0.60f};
    light.intensity = 900;
    light.range = 34;
    light.inner_cone = 0.16f;
    light.outer_cone = 0.42f;
    const vec3 position = foot + floodlight_light;
    scenery.add_light(std::move(light), position, tower - position);
  }
}

}  // namespace

Scene make_landscape(Detail detail) {
  Scenery scenery(detail);
  set_evening(scenery.scene());
  const Terrain terrain(land_site());
  const TownPlan town = plan_town(terrain);
  const CountryPlan country = plan_country(terrain);
  scenery.add_single("land", [&](MeshBuilder& builder) { add_land(builder, terrain, detail); });
  scenery.add_single("lake", [&](MeshBuilder& builder) { add_lake(builder, detail); });
  Node& sky = scenery.add_single("sky", [&](MeshBuilder& builder) { add_sky(builder, sky_dome, detail); });
  // Seen from the overview, which is not under the dome's middle, the painted sun is where the light comes from.
  sky.rotation = glm::angleAxis(sun_azimuth + 0.07f, vec3(0, 1, 0));
  for (const auto* standing : {&town.standing, &country.standing})
    for (const Standing& thing : *standing) scenery.stand(thing);

  Random random(200);
  scenery.add_light(sun(), {0, 100, 0}, -to_sun());
  add_floodlights(scenery, terrain);
  for (const Standing& lamp : country.road_lamps) light_road_lamp(scenery, lamp, random);
  for (const Standing& lamp : country.yard_lamps) scenery.light_lamp(lamp, random);
  const size_t left = landscape_lamp_count + 1 - scenery.scene().lights.size();
  for (const Standing& lamp : choose_lamps(town, left))
    scenery.light_lamp(lamp, random, lamp.model == Model::street_lamp ? street_lamp_scale : 1.0f);
  add_cameras(scenery.scene(), terrain, views);
  return scenery.take();
}

}  // namespace app
