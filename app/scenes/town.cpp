// The plan's things as nodes, a light in every chosen lamp.
#include "scenes/town.hpp"

#include "scenes/cameras.hpp"
#include "scenes/random.hpp"
#include "scenes/scenery.hpp"
#include "scenes/sky.hpp"
#include "scenes/town_plan.hpp"
#include "scenes/town_site.hpp"

namespace app {
namespace {

/// Over the main street towards the church; two at eye height.
constexpr View views[] = {
    {"overview", {10, 62}, 16.3f, {-6, 14}, 3.0f, 52},
    {"street", {-1.0f, 66}, 2.9f, {2.2f, 36}, 4.2f, 54},
    {"square", {5, 17.6f}, 2.6f, {-4.5f, -12}, 5.4f, 55},
};

}  // namespace

Scene make_town(Detail detail) {
  Scenery scenery(detail);
  const Terrain terrain(houses_site());
  const TownPlan plan = plan_town(terrain);
  scenery.add_single("ground", [&](MeshBuilder& builder) { add_town_ground(builder, terrain, detail); });
  scenery.add_single("sky", [&](MeshBuilder& builder) {
    add_sky(builder, {.radius_m = town_world_half_m - 0.5f, .bottom_m = -6, .rise_m = 96}, detail);
  });
  for (const Standing& standing : plan.standing) scenery.stand(standing);
  Random random(256);
  for (const Standing& lamp : choose_lamps(plan, town_light_count)) scenery.light_lamp(lamp, random);
  add_cameras(scenery.scene(), terrain, views);
  return scenery.take();
}

}  // namespace app
