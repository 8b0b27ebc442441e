// Reference of virtual shadow maps (Olsson et al. 2014, sections 3 and 4), in double precision: what a cluster asks of a light's
// map, which maps a light gets for all that is asked of it, and which parts of a map the receivers of a cluster can look up.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/box.hpp"
#include "reference/map_casters.hpp"

namespace reference {

// --- Resolutions ------------------------------------------------------------------------------------------------------

enum class MapKind : uint8_t { cube, spot, sun };

/// A light as its maps see it.
struct MapLight {
  MapKind kind = MapKind::cube;
  glm::dvec3 position{0};          ///< Unused by suns.
  glm::dvec3 direction{0, 0, -1};  ///< Where it shines, unit; used by spots and suns.
  double tangent = 1;              ///< Of the half-angle of its views; 1 on cube faces.
  double near_m = 0;               ///< Spots: receivers count as no nearer.
  double side_m = 0;               ///< Suns: world size of the view's side.
  double max_resolution = 8192;    ///< Of its own.
};

/// A camera's picture, as far as resolutions need it.
struct MapCamera {
  glm::dmat4 view_from_world{1}, clip_from_view{1};
  double width = 0, height = 0;
  double forward = -1;        ///< Sign of view-space z in front of the camera.
  double tile_pixels = 1024;  ///< No cluster covers more.
};

struct Sphere {
  glm::dvec3 center{0};
  double radius = 0;
};
Sphere sphere_around(const Box&);
/// Around the mean of the points.
Sphere sphere_around(std::span<const glm::vec3> points);
/// Of what a sphere hides from a point; everything from within.
double solid_angle(const Sphere&, glm::dvec3 seen_from);

/// Pixels that the box's outline encloses (E1), between one and a tile; a whole tile where the box reaches behind the camera.
double covered_pixels(const MapCamera&, const Box&);
/// The smaller side of a pixel in the world, at the box's depth nearest to the camera but no nearer than `least_depth`.
double nearest_pixel_m(const MapCamera&, const Box&, double least_depth);

/// By how many radians no surface in the sphere with a normal in the cone (cosine of the half-angle) can face the light;
/// negative: one may.
double facing_away_rad(const MapLight&, const Sphere&, glm::dvec3 cone_axis, double cone_cosine);

struct MapRules {
  bool exact = false;       ///< Layout: maps as fine as asked, else levels.
  bool paper = false;       ///< O2 as printed, else corrected (E2, E3).
  bool logarithmic = true;  ///< Buckets, of the exact layout.
  uint32_t maps_per_light = 6;
  double undersampling = 1, least = 4, most = 8192;
};

/// What one cluster asks of the light's map. pixels, sphere: S and what spans alpha; box, pixel_m: its receivers and the size of
/// a pixel there.
double requested_resolution(const MapLight&, const MapRules&, double pixels, const Sphere&, const Box&, double pixel_m);

// --- Maps -------------------------------------------------------------------------------------------------------------

constexpr uint32_t page_side = 32;  ///< Texels; smaller maps are one page a view.

/// The bucket (O8) or, finest first, the level of one request among a light's.
uint32_t place_of_request(double request, double finest, const MapRules&);

/// For each request to one light, the resolution of the map that serves it after so many halvings; all are > 0.
std::vector<uint32_t> map_resolutions(std::span<const double> requests, const MapRules&, uint32_t halvings = 0);

// --- What receivers look up -------------------------------------------------------------------------------------------

/// The samples of a cluster in a block of pixels: a box around their positions and one around their normals.
struct ReceiverBlock {
  Box positions, normals;
};
/// The largest product of any of the normals and a vector to the light from any of the positions; suns: the direction to it.
double largest_facing(const MapLight&, const ReceiverBlock&);

/// Of one view of a map: pages and tiles that some receiver's taps may lie in, and the farthest depth that they compare.
struct ViewMarks {
  uint32_t pages = 1;                             ///< Along the side.
  std::vector<bool> page;                         ///< Row by row.
  std::array<uint32_t, projection_side> tiles{};  ///< Bit x of word y.
  uint32_t grid = 1;
  std::vector<double> farthest;  ///< Cells row by row; 0: no receiver.
  bool seen = false;
};
ViewMarks no_marks(uint32_t resolution, uint32_t grid);

/// Adds the receivers in a box. Views as in CasterView. The box grows by the taps' reach (E7) and tolerance_m, every page and
/// tile by `tolerance` in view coordinates; with negative ones only what is certainly met is marked.
void mark_receivers(const CasterView&, const MapLight&, uint32_t resolution, const Box&, double tolerance,
                    double tolerance_m, ViewMarks&);

}  // namespace reference
