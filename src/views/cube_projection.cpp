// The public face of cube_projection.shared.h.
#include "umbrage/cube_projection.hpp"

#include <algorithm>
#include <cassert>

#include "views/cube_projection.shared.h"

namespace umbrage {

namespace {

shared::vec3 to_shared(Vec3 v) { return shared::vec3(v.x, v.y, v.z); }

}  // namespace

uint32_t cube_face_mask(const Aabb& relative) {
  return shared::face_mask(to_shared(relative.min), to_shared(relative.max));
}

std::optional<CubeFaceProjection> project_to_cube_face(const Aabb& relative, CubeFace face) {
  shared::FaceBox box;
  const shared::uint index = static_cast<shared::uint>(face);
  if (!shared::clip_box_to_face(index, to_shared(relative.min), to_shared(relative.max), box)) return std::nullopt;
  const shared::FaceRect rect = shared::face_rect(box);
  return CubeFaceProjection{.min = {rect.min_st.x, rect.min_st.y},
                            .max = {rect.max_st.x, rect.max_st.y},
                            .depth_min = box.lo.z,
                            .depth_max = box.hi.z};
}

CubeTileRect cube_tile_rect(const CubeFaceProjection& projection, uint32_t tiles) {
  assert(tiles > 0);
  const shared::FaceRect rect{.min_st = {projection.min.x, projection.min.y},
                              .max_st = {projection.max.x, projection.max.y}};
  const shared::TileRect result = shared::tile_rect(rect, tiles);
  return {.x_begin = result.begin.x, .y_begin = result.begin.y, .x_end = result.end.x, .y_end = result.end.y};
}

void cube_tile_mask(const Aabb& relative, CubeFace face, std::span<uint64_t> rows) {
  assert(!rows.empty() && rows.size() <= shared::MaxCubeTiles);
  std::ranges::fill(rows, uint64_t{0});
  shared::FaceBox box;
  const shared::uint index = static_cast<shared::uint>(face);
  if (!shared::clip_box_to_face(index, to_shared(relative.min), to_shared(relative.max), box)) return;
  const auto tiles = static_cast<shared::uint>(rows.size());
  const shared::TileRect rect = shared::tile_rect(shared::face_rect(box), tiles);
  for (shared::uint row = rect.begin.y; row < rect.end.y; ++row) {
    const shared::uvec2 span = shared::tile_row_span(box, row, tiles);
    const shared::uvec2 mask = shared::tile_span_mask(span.x, span.y);
    rows[row] = uint64_t{mask.y} << 32 | mask.x;
  }
}

Aabb grow_receiver_box(const Aabb& relative, uint32_t resolution, float filter_texels, float bias_m) {
  assert(resolution > 0);
  const float margin =
      shared::receiver_margin_m(to_shared(relative.min), to_shared(relative.max), resolution, filter_texels, bias_m);
  return {.min = {relative.min.x - margin, relative.min.y - margin, relative.min.z - margin},
          .max = {relative.max.x + margin, relative.max.y + margin, relative.max.z + margin}};
}

}  // namespace umbrage
