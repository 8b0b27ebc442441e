// Walls with real holes: faces between the openings, reveals, frames, glazing bars, sills, shutters, doors.
#include "scenes/facade.hpp"

#include <algorithm>
#include <cmath>

namespace app {
namespace {

using glm::vec3;

/// The wall's face without its openings, as the cells of the grid that their edges span: no T-junctions.
void add_face(MeshBuilder& builder, const Wall& wall) {
  std::vector<float> xs{-wall.width / 2, wall.width / 2}, ys{wall.bottom, wall.top};
  for (const Opening& o : wall.openings) {
    xs.insert(xs.end(), {o.x - o.width / 2, o.x + o.width / 2});
    ys.insert(ys.end(), {o.y, o.y + o.height});
  }
  const auto tidy = [](std::vector<float>& cuts) {
    std::sort(cuts.begin(), cuts.end());
    const auto same = [](float a, float b) { return b - a < 1e-3f; };
    cuts.erase(std::unique(cuts.begin(), cuts.end(), same), cuts.end());
  };
  tidy(xs);
  tidy(ys);
  for (size_t i = 0; i + 1 < xs.size(); ++i) {
    for (size_t j = 0; j + 1 < ys.size(); ++j) {
      const float x = (xs[i] + xs[i + 1]) / 2, y = (ys[j] + ys[j + 1]) / 2;
      const bool open = std::any_of(wall.openings.begin(), wall.openings.end(), [&](const Opening& o) {
        return std::abs(x - o.x) < o.width / 2 && y > o.y && y < o.y + o.height;
      });
      if (open) continue;
      builder.quad(wall.mat, {xs[i], ys[j], 0}, {xs[i + 1], ys[j], 0}, {xs[i + 1], ys[j + 1], 0},
                   {xs[i], ys[j + 1], 0});
    }
  }
}

void add_reveal(MeshBuilder& builder, Mat mat, float w, float h) {
  const float x = w / 2, back = -reveal_m - 0.06f;
  builder.quad(mat, {-x, 0, 0}, {x, 0, 0}, {x, 0, back}, {-x, 0, back});
  builder.quad(mat, {-x, h, back}, {x, h, back}, {x, h, 0}, {-x, h, 0});
  builder.quad(mat, {-x, 0, 0}, {-x, 0, back}, {-x, h, back}, {-x, h, 0});
  builder.quad(mat, {x, 0, back}, {x, 0, 0}, {x, h, 0}, {x, h, back});
}

/// A frame around w × h and `columns` × `rows` panes inside it.
void add_sash(MeshBuilder& builder, Mat mat, float w, float h, int columns, int rows) {
  using Ends = MeshBuilder::Ends;
  const float x = w / 2, z = -reveal_m, back = z - 0.04f, rim = 0.06f;
  builder.bar(mat, {-x, 0, back}, {-x + rim, h, z}, Ends::not_y);
  builder.bar(mat, {x - rim, 0, back}, {x, h, z}, Ends::not_y);
  builder.bar(mat, {-x + rim, 0, back}, {x - rim, rim, z}, Ends::not_x);
  builder.bar(mat, {-x + rim, h - rim, back}, {x - rim, h, z}, Ends::not_x);
  for (int i = 1; i < columns; ++i) {
    const float at = -x + w * static_cast<float>(i) / static_cast<float>(columns);
    builder.bar(mat, {at - 0.02f, rim, back}, {at + 0.02f, h - rim, z - 0.01f}, Ends::not_y);
  }
  for (int i = 1; i < rows; ++i) {
    const float at = h * static_cast<float>(i) / static_cast<float>(rows);
    builder.bar(mat, {-x + rim, at - 0.015f, back}, {x - rim, at + 0.015f, z - 0.015f}, Ends::not_x);
  }
}

/// A louvred leaf, hinged at x = `hinge` and opening towards `side`, lying almost flat on the wall.
void add_shutter(MeshBuilder& builder, Mat mat, float hinge, float side, float w, float h) {
  const auto scope = builder.at({hinge, 0, 0.03f}, -0.14f * side);
  const float inner = side > 0 ? 0.0f : -w, outer = inner + w, rim = 0.06f;
  builder.box(mat, {inner, 0, 0}, {outer, h, 0.02f});
  builder.bar(mat, {inner, 0, 0.02f}, {inner + rim, h, 0.05f}, MeshBuilder::Ends::not_y);
  builder.bar(mat, {outer - rim, 0, 0.02f}, {outer, h, 0.05f}, MeshBuilder::Ends::not_y);
  const int slats = static_cast<int>(h / 0.3f);
  for (int i = 0; i < slats; ++i) {
    const float low = h * static_cast<float>(i) / static_cast<float>(slats),
                high = h * static_cast<float>(i + 1) / static_cast<float>(slats);
    const float l = inner + rim, r = outer - rim, z = 0.02f, out = 0.05f;
    builder.quad(mat, {l, low + 0.02f, out}, {r, low + 0.02f, out}, {r, high, z}, {l, high, z});
    builder.quad(mat, {l, low, z}, {r, low, z}, {r, low + 0.02f, out}, {l, low + 0.02f, out});
  }
}

void add_window(MeshBuilder& builder, const Opening& o, Mat reveal, Random& random) {
  const bool shop = o.kind == OpeningKind::shop_window;
  add_reveal(builder, reveal, o.width, o.height);
  const float x = o.width / 2, z = -reveal_m - 0.03f;
  builder.picture(o.pane, {-x, 0, z}, {x, 0, z}, {x, o.height, z}, {-x, o.height, z});
  add_sash(builder, o.frame, o.width, o.height, shop ? 4 : 2, shop ? 2 : 3);
  builder.bar(Mat::trim, {-x - 0.10f, -0.09f, 0}, {x + 0.10f, 0, 0.09f});
  builder.bar(Mat::trim, {-x - 0.08f, o.height, 0}, {x + 0.08f, o.height + 0.13f, 0.04f});
  if (o.shutters) {
    add_shutter(builder, *o.shutters, x + 0.02f, 1, o.width / 2, o.height);
    add_shutter(builder, *o.shutters, -x - 0.02f, -1, o.width / 2, o.height);
  }
  if (o.flowers) {
    builder.box(Mat::timber, {-x, 0.0f, 0.0f}, {x, 0.16f, 0.2f});
    add_flowers(builder, {0, 0.2f, 0.12f}, {x, 0.1f, 0.12f}, 18, random);
  }
}

void add_door(MeshBuilder& builder, const Opening& o, Mat reveal) {
  add_reveal(builder, reveal, o.width, o.height);
  const float x = o.width / 2, z = -reveal_m, light = 0.36f;  // A pane over the leaf.
  const float leaf = o.height - light;
  builder.box(o.frame, {-x, 0, z - 0.06f}, {x, leaf - 0.04f, z});
  for (float side : {-1.0f, 1.0f}) {
    for (float y : {0.14f, 0.98f}) {
      builder.box(o.frame, {side * x * 0.5f - x * 0.34f, y, z}, {side * x * 0.5f + x * 0.34f, y + 0.66f, z + 0.025f});
    }
    builder.box(Mat::trim, {side * (x + 0.1f) - 0.1f, 0, -0.02f}, {side * (x + 0.1f) + 0.1f, o.height + 0.02f, 0.05f});
  }
  builder.ball(Mat::gold, {x - 0.12f, 0.95f, z + 0.05f}, 0.035f, 6);
  builder.box(o.frame, {-x, leaf - 0.04f, z - 0.05f}, {x, leaf + 0.03f, z + 0.02f});
  builder.picture(o.pane, {-x, leaf, z - 0.03f}, {x, leaf, z - 0.03f}, {x, o.height, z - 0.03f},
                  {-x, o.height, z - 0.03f});
  for (float bar : {-x / 2, 0.0f, x / 2})
    builder.box(o.frame, {bar - 0.015f, leaf + 0.03f, z - 0.04f}, {bar + 0.015f, o.height, z - 0.01f});
  builder.box(Mat::trim, {-x - 0.24f, o.height, -0.02f}, {x + 0.24f, o.height + 0.2f, 0.09f});
  // A little roof on brackets, and steps that go down into any ground.
  builder.block(Mat::timber, {vec3{-x - 0.3f, o.height + 0.30f, 0.75f},
                              {x + 0.3f, o.height + 0.30f, 0.75f},
                              {x + 0.3f, o.height + 0.55f, 0},
                              {-x - 0.3f, o.height + 0.55f, 0},
                              {-x - 0.3f, o.height + 0.36f, 0.75f},
                              {x + 0.3f, o.height + 0.36f, 0.75f},
                              {x + 0.3f, o.height + 0.61f, 0},
                              {-x - 0.3f, o.height + 0.61f, 0}});
  for (float side : {-1.0f, 1.0f}) {
    const float at = side * (x + 0.17f);
    builder.beam(Mat::timber, {at, o.height - 0.25f, 0.07f}, {at, o.height + 0.31f, 0.68f}, 0.06f, 0.07f);
  }
  builder.box(Mat::trim, {-x - 0.2f, -0.9f, -0.1f}, {x + 0.2f, 0, 0.42f});
  builder.box(Mat::trim, {-x - 0.35f, -0.9f, 0.42f}, {x + 0.35f, -0.17f, 0.76f});
}

void add_low_opening(MeshBuilder& builder, const Opening& o) {
  const float x = o.width / 2, h = o.height;
  const bool door = o.kind == OpeningKind::door;
  builder.picture(door ? o.frame : o.pane, {-x, 0, 0.01f}, {x, 0, 0.01f}, {x, h, 0.01f}, {-x, h, 0.01f});
  if (o.shutters) {
    for (float side : {-1.0f, 1.0f}) {
      const float at = side * (x * 1.5f + 0.02f);
      builder.quad(*o.shutters, {at - x / 2, 0, 0.04f}, {at + x / 2, 0, 0.04f}, {at + x / 2, h, 0.04f},
                   {at - x / 2, h, 0.04f});
    }
  }
  if (door) builder.box(Mat::trim, {-x - 0.2f, -0.9f, -0.1f}, {x + 0.2f, 0, 0.6f});
}

}  // namespace

Mat pick_pane(Random& random) {
  const float pick = random.unit();
  return pick < 0.18f ? Mat::window_bright : pick < 0.46f ? Mat::window_warm : Mat::glass;
}

void add_flowers(MeshBuilder& builder, vec3 centre, vec3 spread, int count, Random& random) {
  for (int i = 0; i < count; ++i) {
    const vec3 offset{random.around(1), random.around(1), random.around(1)};
    const vec3 normal = glm::normalize(vec3(offset.x, 1.1f, offset.z + 0.6f));
    const vec3 along = glm::normalize(vec3(random.around(1), random.range(0.1f, 0.8f), random.around(1)));
    const vec3 across = glm::normalize(glm::cross(normal, along));
    const bool petal = i % 3 == 0;
    const Mat mat = petal ? (i % 2 ? Mat::petal_red : Mat::petal_yellow) : Mat::leaf_green;
    builder.leaf(mat, centre + spread * offset + vec3(0, petal ? 0.06f : 0, 0), along * 0.13f, across * 0.045f, normal);
  }
}

void add_wall(MeshBuilder& builder, const Wall& wall, Detail detail, Random random) {
  const float x = wall.width / 2;
  if (detail == Detail::low)
    builder.quad(wall.mat, {-x, wall.bottom, 0}, {x, wall.bottom, 0}, {x, wall.top, 0}, {-x, wall.top, 0});
  else
    add_face(builder, wall);
  if (wall.gable) builder.triangle(wall.mat, {-x, wall.top, 0}, {x, wall.top, 0}, {0, *wall.gable, 0});
  for (const Opening& opening : wall.openings) {
    const auto scope = builder.at({opening.x, opening.y, 0});
    if (detail == Detail::low)
      add_low_opening(builder, opening);
    else if (opening.kind == OpeningKind::door)
      add_door(builder, opening, wall.mat);
    else
      add_window(builder, opening, wall.mat, random);
  }
}

void add_timber(MeshBuilder& builder, const Wall& wall, Mat mat, Detail detail) {
  if (detail == Detail::low) return;
  const float x = wall.width / 2, z = 0.02f;
  const auto bar = [&](vec3 from, vec3 to) { builder.beam(mat, from, to, 0.16f, 0.07f, {0.9f, 0.43f, 0}); };
  const float low = wall.bottom + 0.09f, high = wall.top - 0.09f;
  bar({-x, low, z}, {x, low, z});
  bar({-x, high, z}, {x, high, z});
  std::vector<float> posts{-x + 0.08f, x - 0.08f};
  for (const Opening& o : wall.openings) {
    if (o.y + o.height < wall.bottom || o.y > wall.top) continue;
    posts.insert(posts.end(), {o.x - o.width / 2 - 0.09f, o.x + o.width / 2 + 0.09f});
  }
  std::sort(posts.begin(), posts.end());
  posts.erase(std::unique(posts.begin(), posts.end(), [](float a, float b) { return b - a < 0.3f; }), posts.end());
  for (size_t i = 0; i + 1 < posts.size(); ++i) {
    // No field wider than carpenters would leave it.
    const float gap = posts[i + 1] - posts[i];
    if (gap > 2.2f)
      posts.insert(posts.begin() + static_cast<std::ptrdiff_t>(i) + 1, posts[i] + gap / std::ceil(gap / 1.6f));
  }
  for (float post : posts) bar({post, low + 0.08f, z}, {post, high - 0.08f, z});
  const auto brace = [&](float a, float b) {
    if (std::abs(b - a) < 0.45f) return;
    const float reach = std::min(std::abs(b - a), 1.3f) * (b > a ? 1.0f : -1.0f);
    bar({a, high - 0.1f - 1.25f * std::abs(reach), z - 0.005f}, {a + reach, high - 0.1f, z - 0.005f});
  };
  brace(posts.front() + 0.05f, posts[1] - 0.1f);
  brace(posts.back() - 0.05f, posts[posts.size() - 2] + 0.1f);
  if (!wall.gable) return;
  const float rise = *wall.gable - wall.top;
  const auto width_at = [&](float y) { return x * (1 - (y - wall.top) / rise); };
  const float collar = wall.top + rise * 0.5f;
  bar({-width_at(collar) + 0.1f, collar, z}, {width_at(collar) - 0.1f, collar, z});
  bar({0, wall.top, z}, {0, *wall.gable - 0.3f, z});
  for (float side : {-1.0f, 1.0f}) {
    bar({side * x * 0.5f, wall.top, z}, {side * x * 0.5f, collar - 0.05f, z});
    bar({side * x * 0.92f, wall.top + 0.05f, z - 0.004f}, {side * x * 0.08f, *wall.gable - rise * 0.12f, z - 0.004f});
  }
}

void add_railing(MeshBuilder& builder, Mat mat, vec3 from, vec3 to, float height, Detail detail) {
  const vec3 along = to - from, up{0, height, 0};
  const vec3 side = glm::normalize(glm::cross(along, up));
  builder.beam(mat, from + up, to + up, 0.07f, 0.05f, side);
  if (detail == Detail::low) return;
  builder.beam(mat, from + 0.12f * up, to + 0.12f * up, 0.04f, 0.04f, side);
  const int count = static_cast<int>(glm::length(along) / 0.17f);
  for (int i = 0; i <= count; ++i) {
    const vec3 foot = from + along * (static_cast<float>(i) / static_cast<float>(count));
    const bool post = i == 0 || i == count;
    builder.stand(mat, foot, {post ? 0.07f : 0.028f, height, post ? 0.07f : 0.028f});
  }
}

void add_awning(MeshBuilder& builder, Mat stripe, float width, float y, Detail detail) {
  const float reach = 1.3f, drop = 0.4f;
  const int strips = detail == Detail::low ? 1 : static_cast<int>(width / 0.36f);
  for (int i = 0; i < strips; ++i) {
    const float a = width * (static_cast<float>(i) / static_cast<float>(strips) - 0.5f);
    const float b = width * (static_cast<float>(i + 1) / static_cast<float>(strips) - 0.5f);
    const Mat mat = i % 2 ? Mat::cloth_white : stripe;
    builder.block(mat, {vec3{a, y - drop, reach},
                        {b, y - drop, reach},
                        {b, y, 0},
                        {a, y, 0},
                        {a, y - drop + 0.02f, reach},
                        {b, y - drop + 0.02f, reach},
                        {b, y + 0.02f, 0},
                        {a, y + 0.02f, 0}});
    builder.box(mat, {a, y - drop - 0.2f, reach - 0.01f}, {b, y - drop + 0.015f, reach + 0.01f});
  }
  if (detail == Detail::low) return;
  for (float side : {-1.0f, 1.0f}) {
    const float x = side * (width / 2 - 0.05f);
    builder.beam(Mat::iron, {x, y - drop - 0.25f, 0}, {x, y - drop - 0.02f, reach}, 0.03f, 0.03f);
  }
}

}  // namespace app
