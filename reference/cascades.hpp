// The listings of "CSM Scrolling" followed line by line, with the sets S, S', ΔS and A as sets: what the device decides from times and
// volume tests alone must come out the same. And its maps, drawn and scrolled texel by texel.
#pragma once
#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace reference {

/// Inclusive cells of the light's grid: texels, texels, depth units.
struct GridCells {
  glm::ivec3 lo{0}, hi{0};
};

/// A volume V, open towards the light: what lies before it is drawn at depth 0.
struct CascadeVolume {
  glm::ivec3 origin{0};
  int side = 0;
  bool operator==(const CascadeVolume&) const = default;
  /// Any cell of the box at texel (x, y) of the grid, no deeper than the far side.
  bool holds(const GridCells&) const;
  bool holds_texel(int x, int y) const;
};

struct CascadeCaster {
  GridCells box;
  bool is_static = true;
};

enum class CascadeScheme : uint8_t { cached, scrolled };
enum class CascadeErrata : uint8_t { paper, corrected };

/// What one frame does with a static map C and draws.
struct CascadeDecision {
  bool redraws = true;                   ///< C was invalid: clear, draw S.
  std::optional<glm::ivec3> scrolls_by;  ///< Else, if V ≠ V'.
  std::set<uint32_t> into_static;        ///< S if redrawn, else ΔS.
  std::set<uint32_t> into_working;       ///< A
};

/// State of one cascade: C's validity, V', S' with the cached positions of its members.
class CascadeListing {
 public:
  CascadeListing(CascadeScheme scheme, CascadeErrata errata) : scheme_(scheme), errata_(errata) {}
  CascadeDecision frame(const CascadeVolume&, const std::map<uint32_t, CascadeCaster>&,
                        bool projection_changed = false);

 private:
  CascadeScheme scheme_;
  CascadeErrata errata_;
  bool is_valid_ = false;
  CascadeVolume volume_;
  std::map<uint32_t, GridCells> static_;
};

/// Texels (of the map of `now`) at which a static caster must be drawn again after a scroll, by the definition of V \ V' in three
/// dimensions (E17, E18): covered by its box, and new at the side, or with depths that V' could not hold.
std::vector<bool> texels_to_draw(const CascadeVolume& now, const CascadeVolume& former, const GridCells& box);

/// A map of 16-bit depths, 65535 = clear.
struct CascadeMap {
  explicit CascadeMap(const CascadeVolume& v) : volume(v), depth(static_cast<size_t>(v.side) * v.side, 65535) {}
  CascadeVolume volume;
  std::vector<uint32_t> depth;
};
CascadeMap scrolled(const CascadeMap&, const CascadeVolume&);
/// Vertices in grid coordinates; texels x, y in sub-texels of 1/256, the top-left rule, depth in double precision.
void draw_triangle(CascadeMap&, const std::array<glm::dvec3, 3>& grid);

/// Texture coordinate u that the listing's quad has at (x, y) of a unit square, drawn as the strip of its four vertices: verts[2] has
/// u0 as printed, or u1 (E15).
double quad_u(double x, double y, double u0, double u1, bool as_printed);
/// A 16-bit depth after the volume has moved `moves` times by `steps` of 1/steps_per_range: 65536 as printed, or 65535 (E16).
uint32_t depth_after_moves(uint32_t depth, int moves, int steps, double steps_per_range);

}  // namespace reference
