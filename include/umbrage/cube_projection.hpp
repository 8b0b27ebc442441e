// Axis-aligned boxes projected onto a cube map (after Olsson et al. 2014, poster): the faces, rectangles, tiles and
// depths that a box covers. Needs no Vulkan and no ShadowSystem; thread-safe. shaders/cube_projection.glsl is the same
// code for shaders (umbrage_face_mask, umbrage_clip_box_to_face, …); docs/cube-projection.md derives it.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "umbrage/types.hpp"

namespace umbrage {

/// Oriented as the cube maps of Vulkan and OpenGL: s runs right and t down in the face's image.
enum class CubeFace : uint8_t { x_plus, x_minus, y_plus, y_minus, z_plus, z_minus };

/// What a face sees of a box: its bounding rectangle, -1…1, exact up to 2e-6 that it is grown by, and the range of its
/// depth along the face's axis, exact.
struct CubeFaceProjection {
  Vec2 min, max;
  float depth_min = 0, depth_max = 0;
};

/// Tiles begin <= (x, y) < end of a face.
struct CubeTileRect {
  uint32_t x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;
};

// Boxes are closed, finite, and relative to the light: subtract its position from both corners. A box with any min >
// max or NaN is empty: no face sees it.

/// Bit f is set when face f sees the box; exact.
uint32_t cube_face_mask(const Aabb& relative);

/// Nothing when the face does not see the box, exactly as in cube_face_mask.
std::optional<CubeFaceProjection> project_to_cube_face(const Aabb& relative, CubeFace);

/// The tiles that a rectangle touches on a face of tiles × tiles; tiles > 0. Tile i is half-open, [i, i + 1) / tiles
/// of the side, but the last one is closed.
CubeTileRect cube_tile_rect(const CubeFaceProjection&, uint32_t tiles);

/// Sets bit x of rows[y] for the tiles that the box's silhouette touches (never more than its rectangle's) and clears
/// the others; the face has rows.size() × rows.size() tiles, 1…64.
void cube_tile_mask(const Aabb& relative, CubeFace, std::span<uint64_t> rows);

/// Grows a box of receivers, so that its projection holds every filter tap up to filter_texels away in s and t, across
/// edges too, of receivers moved by up to bias_m. resolution > 0: texels along a face's side.
Aabb grow_receiver_box(const Aabb& relative, uint32_t resolution, float filter_texels, float bias_m);

}  // namespace umbrage
