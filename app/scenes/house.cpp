// Houses from the parts of facade.hpp and roof.hpp.
#include "scenes/house.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace app {
namespace {

using glm::vec3;

constexpr std::array base_styles{
    HouseStyle{.name = "weaver",
               .width = 7.2f,
               .depth = 8.5f,
               .roof = RoofKind::gable_front,
               .pitch = 1.25f,
               .wall = Mat::plaster_white,
               .roof_tiles = Mat::roof_red,
               .paint = Mat::paint_green,
               .timbered = true,
               .jetty_m = 0.35f,
               .flowers = true,
               .seed = 3},
    HouseStyle{.name = "cooper",
               .width = 9.6f,
               .depth = 8,
               .pitch = 1.0f,
               .wall = Mat::plaster_ochre,
               .roof_tiles = Mat::roof_red,
               .paint = Mat::paint_green,
               .shutters = true,
               .flowers = true,
               .dormers = 2,
               .seed = 5},
    HouseStyle{.name = "baker",
               .width = 8.4f,
               .depth = 9,
               .storeys = 3,
               .roof = RoofKind::gable_front,
               .pitch = 1.2f,
               .wall = Mat::plaster_rose,
               .roof_tiles = Mat::roof_brown,
               .paint = Mat::paint_white,
               .shutters = true,
               .shop = true,
               .seed = 7},
    HouseStyle{.name = "notary",
               .width = 10.5f,
               .depth = 9,
               .roof = RoofKind::hip,
               .pitch = 0.85f,
               .wall = Mat::plaster_cream,
               .roof_tiles = Mat::roof_slate,
               .paint = Mat::paint_blue,
               .shutters = true,
               .balcony = true,
               .dormers = 1,
               .seed = 11},
    HouseStyle{.name = "farrier",
               .width = 8.8f,
               .depth = 8,
               .storeys = 1,
               .pitch = 1.1f,
               .wall = Mat::stone,
               .roof_tiles = Mat::roof_brown,
               .paint = Mat::paint_red,
               .flowers = true,
               .dormers = 2,
               .wing_m = 5,
               .seed = 13},
    HouseStyle{.name = "brewer",
               .width = 9.0f,
               .depth = 9,
               .storeys = 3,
               .pitch = 1.05f,
               .wall = Mat::plaster_white,
               .roof_tiles = Mat::roof_red,
               .paint = Mat::paint_red,
               .timbered = true,
               .jetty_m = 0.3f,
               .shop = true,
               .dormers = 2,
               .seed = 17},
    HouseStyle{.name = "widow",
               .width = 6.4f,
               .depth = 7.5f,
               .roof = RoofKind::gable_front,
               .pitch = 1.15f,
               .wall = Mat::plaster_blue,
               .roof_tiles = Mat::roof_slate,
               .paint = Mat::paint_white,
               .shutters = true,
               .flowers = true,
               .seed = 19},
    HouseStyle{.name = "miller",
               .width = 9.2f,
               .depth = 7.6f,
               .pitch = 1.05f,
               .wall = Mat::plaster_sage,
               .roof_tiles = Mat::roof_brown,
               .paint = Mat::paint_white,
               .shutters = true,
               .balcony = true,
               .wing_m = 6,
               .seed = 23},
    HouseStyle{.name = "printer",
               .width = 7.6f,
               .depth = 8.5f,
               .storeys = 3,
               .roof = RoofKind::gable_front,
               .pitch = 1.3f,
               .wall = Mat::plaster_cream,
               .roof_tiles = Mat::roof_brown,
               .paint = Mat::paint_blue,
               .timbered = true,
               .jetty_m = 0.3f,
               .shop = true,
               .seed = 29},
    HouseStyle{.name = "gardener",
               .width = 8.0f,
               .depth = 7.5f,
               .storeys = 1,
               .pitch = 1.2f,
               .wall = Mat::plaster_ochre,
               .roof_tiles = Mat::roof_red,
               .paint = Mat::paint_blue,
               .timbered = false,
               .shutters = true,
               .flowers = true,
               .dormers = 1,
               .seed = 31},
};

/// Every style once more with other colours and other people at home.
constexpr auto styles = [] {
  constexpr std::array walls{Mat::plaster_cream, Mat::plaster_sage, Mat::plaster_rose, Mat::plaster_white,
                             Mat::plaster_ochre};
  constexpr std::array paints{Mat::paint_red, Mat::paint_white, Mat::paint_blue, Mat::paint_green};
  std::array<HouseStyle, 2 * base_styles.size()> result{};
  for (size_t i = 0; i < base_styles.size(); ++i) {
    HouseStyle other = base_styles[i];
    if (other.wall != Mat::stone) other.wall = walls[(i + 1) % walls.size()];
    other.paint = paints[i % paints.size()];
    if (other.roof_tiles != Mat::roof_slate) other.roof_tiles = i % 2 ? Mat::roof_brown : Mat::roof_red;
    other.flowers = !other.flowers;
    other.seed += 100;
    result[2 * i] = base_styles[i];
    result[2 * i + 1] = other;
  }
  return result;
}();

struct Storey {
  int index = 0;
  float left, right, back, front;
  float bottom, top;
};

int bay_count(const Wall& wall, const HouseStyle& style) {
  return std::max(1, static_cast<int>((wall.width - 0.5f) / (style.shutters ? 2.15f : 1.9f)));
}

/// Evenly spaced windows; with a door, its bay is left to the caller through `skip`.
void add_bays(Wall& wall, const HouseStyle& style, float floor, int count, int skip, Random& random) {
  const float step = (wall.width - 0.4f) / static_cast<float>(count);
  for (int i = 0; i < count; ++i) {
    if (i == skip) continue;
    Opening window{.x = (static_cast<float>(i) + 0.5f - 0.5f * static_cast<float>(count)) * step, .y = floor + 0.85f};
    window.height = 1.25f;
    window.pane = pick_pane(random);
    if (style.shutters) window.shutters = style.paint;
    window.frame = style.paint == Mat::paint_white ? Mat::timber : Mat::paint_white;
    window.flowers = style.flowers && random.chance(0.45f);
    wall.openings.push_back(window);
  }
}

void fill_ground_front(Wall& wall, const HouseStyle& style, Random& random) {
  const Mat door = style.paint == Mat::paint_white ? Mat::paint_green : style.paint;
  if (style.shop) {
    const float side = wall.width / 2 - 0.95f;
    wall.openings.push_back({.kind = OpeningKind::door,
                             .x = side,
                             .width = 1.05f,
                             .height = 2.4f,
                             .pane = Mat::window_warm,
                             .frame = door});
    wall.openings.push_back({.kind = OpeningKind::shop_window,
                             .x = -0.75f,
                             .y = 0.7f,
                             .width = wall.width - 3.2f,
                             .height = 1.6f,
                             .pane = Mat::window_bright,
                             .frame = door});
    return;
  }
  const int bays = bay_count(wall, style);
  const int skip = bays / 2;
  const float step = (wall.width - 0.4f) / static_cast<float>(bays);
  const float x = (static_cast<float>(skip) + 0.5f - 0.5f * static_cast<float>(bays)) * step;
  wall.openings.push_back(
      {.kind = OpeningKind::door, .x = x, .width = 1.05f, .height = 2.4f, .pane = pick_pane(random), .frame = door});
  add_bays(wall, style, 0, bays, skip, random);
}

void add_balcony(MeshBuilder& builder, const HouseStyle& style, float floor, Detail detail) {
  const float half = 1.7f, reach = 1.1f;
  builder.box(Mat::trim, {-half, floor - 0.12f, -0.05f}, {half, floor + 0.02f, reach});
  for (float x : {-half + 0.2f, half - 0.2f}) {
    builder.beam(Mat::timber, {x, floor - 0.8f, 0.02f}, {x, floor - 0.12f, reach - 0.2f}, 0.12f, 0.12f);
  }
  const Mat rail = style.paint == Mat::paint_white ? Mat::paint_white : Mat::iron;
  add_railing(builder, rail, {-half + 0.04f, floor, reach - 0.05f}, {half - 0.04f, floor, reach - 0.05f}, 0.95f,
              detail);
  for (float x : {-half + 0.04f, half - 0.04f})
    add_railing(builder, rail, {x, floor, 0}, {x, floor, reach - 0.05f}, 0.95f, detail);
}

/// Sits on a gable's face: its trim hides that there is no hole behind it.
void add_attic_window(MeshBuilder& builder, float y, Mat paint, Mat pane, Detail detail) {
  const auto scope = builder.at({0, y, 0.095f});
  builder.picture(pane, {-0.32f, 0, 0}, {0.32f, 0, 0}, {0.32f, 0.8f, 0}, {-0.32f, 0.8f, 0});
  if (detail == Detail::low) return;
  builder.bar(Mat::trim, {-0.42f, -0.08f, -0.095f}, {0.42f, 0.88f, -0.01f});
  builder.bar(paint, {-0.02f, 0, 0}, {0.02f, 0.8f, 0.02f});
  builder.bar(paint, {-0.32f, 0.38f, 0}, {0.32f, 0.42f, 0.02f});
}

/// The four walls of a storey; the frame's origin is the middle of the house's front.
void add_storey(MeshBuilder& builder, const HouseStyle& style, const Storey& s, const Roof* roof, Detail detail,
                Random& random) {
  const float mid_x = (s.left + s.right) / 2, mid_z = (s.front + s.back) / 2;
  const bool beams = style.timbered && s.index > 0;
  HouseStyle plain = style;  // Away from the street.
  plain.shutters = plain.flowers = false;
  for (int side = 0; side < 4; ++side) {
    const bool facing_z = side % 2 == 0;
    Wall wall{
        .width = facing_z ? s.right - s.left : s.front - s.back, .bottom = s.bottom, .top = s.top, .mat = style.wall};
    if (style.timbered && s.index == 0) wall.mat = Mat::stone;
    if (roof &&
        ((roof->kind == RoofKind::gable_side && !facing_z) || (roof->kind == RoofKind::gable_front && facing_z)))
      wall.gable = roof->apex();
    const vec3 middle = side == 0   ? vec3(mid_x, 0, s.front)
                        : side == 1 ? vec3(s.right, 0, mid_z)
                        : side == 2 ? vec3(mid_x, 0, s.back)
                                    : vec3(s.left, 0, mid_z);
    const auto scope = builder.at(middle, 1.5707963f * static_cast<float>(side));
    if (side == 0 && s.index == 0)
      fill_ground_front(wall, style, random);
    else if (side == 0)
      add_bays(wall, style, s.bottom, bay_count(wall, style), -1, random);
    else
      add_bays(wall, plain, s.bottom, side == 2 ? 2 : 1, -1, random);
    if (wall.gable && *wall.gable - s.top > 2.2f)
      add_attic_window(builder, s.top + 0.75f, style.paint, pick_pane(random), detail);
    add_wall(builder, wall, detail, random);
    if (beams && side != 2) add_timber(builder, wall, Mat::timber, detail);
    if (side == 0 && s.index == 0 && style.shop) {
      const auto awning = builder.at({-0.75f, 0, 0});
      add_awning(builder, style.paint == Mat::paint_blue ? Mat::cloth_blue : Mat::cloth_red, wall.width - 2.8f, 2.5f,
                 detail);
    }
  }
}

void add_jetty(MeshBuilder& builder, const Storey& s, float below_front, bool brackets) {
  if (s.front - below_front < 0.05f) return;
  builder.box(Mat::timber, {s.left, s.bottom - 0.18f, below_front - 0.02f},
              {s.right, s.bottom + 0.02f, s.front + 0.02f});
  if (!brackets) return;
  const int count = static_cast<int>((s.right - s.left) / 1.5f);
  for (int i = 0; i <= count; ++i) {
    const float x = s.left + 0.1f + (s.right - s.left - 0.2f) * static_cast<float>(i) / static_cast<float>(count);
    builder.beam(Mat::timber, {x, s.bottom - 0.62f, below_front + 0.02f}, {x, s.bottom - 0.16f, s.front - 0.06f}, 0.14f,
                 0.14f);
  }
}

void add_wing(MeshBuilder& builder, const HouseStyle& style, Detail detail, Random& random) {
  HouseStyle wing = style;
  wing.shop = wing.balcony = wing.flowers = false;
  const Storey s{.index = 1,
                 .left = -2.4f,
                 .right = 2.4f,
                 .back = -style.wing_m - 0.2f,
                 .front = 0.2f,
                 .bottom = 0,
                 .top = storey_m};
  const Roof roof{.kind = RoofKind::gable_front,
                  .left = s.left,
                  .right = s.right,
                  .back = s.back,
                  .front = s.front,
                  .eave = s.top,
                  .pitch = style.pitch,
                  .overhang = 0.35f,
                  .tiles = style.roof_tiles};
  const auto scope = builder.at({style.width / 2 - 2.4f, 0, -style.depth});
  builder.box(Mat::stone, {s.left - 0.05f, -1.6f, s.back - 0.05f}, {s.right + 0.05f, 0, s.front});
  add_storey(builder, wing, s, &roof, detail, random);
  add_roof(builder, roof, detail, random);
}

}  // namespace

std::span<const HouseStyle> house_styles() { return styles; }

void add_house(MeshBuilder& builder, const HouseStyle& style, Detail detail) {
  Random random(style.seed);
  const float half = style.width / 2;
  builder.box(Mat::stone, {-half - 0.06f, -1.6f, -style.depth - 0.06f}, {half + 0.06f, 0, 0.06f});
  Roof roof{.kind = style.roof,
            .left = -half,
            .right = half,
            .back = -style.depth,
            .pitch = style.pitch,
            .tiles = style.roof_tiles};
  roof.front = style.jetty_m * static_cast<float>(style.storeys - 1);
  roof.eave = storey_m * static_cast<float>(style.storeys) + 0.1f;
  if (style.roof == RoofKind::gable_side && style.storeys == 1) roof.eave += 0.35f;
  for (int i = 0; i < style.storeys; ++i) {
    const bool top = i + 1 == style.storeys;
    const float floor = storey_m * static_cast<float>(i);
    const Storey s{.index = i,
                   .left = -half,
                   .right = half,
                   .back = -style.depth,
                   .front = style.jetty_m * static_cast<float>(i),
                   .bottom = floor,
                   .top = top ? roof.eave : floor + storey_m};
    add_storey(builder, style, s, top ? &roof : nullptr, detail, random);
    add_jetty(builder, s, s.front - style.jetty_m, detail == Detail::full && !(style.shop && i == 1));
    if (!style.timbered && !top && detail == Detail::full) {
      builder.box(Mat::trim, {-half - 0.05f, s.top - 0.08f, -style.depth - 0.05f},
                  {half + 0.05f, s.top + 0.06f, 0.05f});
    }
  }
  add_roof(builder, roof, detail, random);
  for (int i = 0; i < style.dormers; ++i) {
    const float x = style.width * 0.5f * ((static_cast<float>(i) + 0.5f) / static_cast<float>(style.dormers) - 0.5f);
    add_dormer(builder, roof, x, style.wall, Mat::paint_white, detail, random);
  }
  const bool front_gable = style.roof == RoofKind::gable_front;
  const float x = front_gable ? half * 0.45f : half * 0.55f, z = -style.depth * (front_gable ? 0.7f : 0.62f);
  add_chimney(builder, x, z, roof.eave - 0.2f, roof.apex() + 0.75f, detail);
  if (style.balcony) add_balcony(builder, style, storey_m, detail);
  if (style.wing_m > 0) add_wing(builder, style, detail, random);
}

}  // namespace app
