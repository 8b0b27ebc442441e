// What the host decides about cascades: where the camera is split, how large each volume is, and by how many whole texels and depth
// units it moves (C7). One frame of history; no device.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "cascades/cascade_types.shared.h"
#include "clusters/cluster_types.shared.h"

namespace umbrage::cascades {

/// How static maps live on from frame to frame.
enum class Mode : uint8_t {
  redraw,            ///< They do not.
  cached,            ///< While the volume stands still (C2).
  scrolled,          ///< And are scrolled when it moves (C3), with the sets corrected (E17, E18).
  scrolled_literal,  ///< With the sets as printed.
  guard_band,        ///< Larger maps, in which the volume moves about until it leaves them (C8).
};

/// Cascades of a light at most.
constexpr uint32_t kMostOfLight = 8;

struct CascadeSettings {
  Mode mode = Mode::scrolled;
  uint32_t count = 4;          ///< Of a light, 1…kMostOfLight.
  uint32_t resolution = 512;   ///< Texels along a side, a multiple of CellTexels.
  float distance_m = 200;      ///< Where the last one ends.
  float log_share = 0.8f;      ///< Of the splits: 0 evenly spaced, 1 each as many times farther than the one before.
  float reach_m = 100;         ///< Of the volume towards the light; what lies beyond casts with depth 0.
  uint32_t guard_texels = 64;  ///< guard_band: on each side, a multiple of CellTexels / 2.
  float blend = 0.1f;          ///< Part of a cascade's depth that the next one holds too.
  uint32_t static_after = 10 * shared::TicksPerSecond;
  bool operator==(const CascadeSettings&) const = default;
};

struct CascadeLight {
  uint32_t slot = 0;
  glm::vec3 direction_ws{0, -1, 0};  ///< Where it shines.
  uint32_t light_mask = 0xffffffffu;
  bool operator==(const CascadeLight&) const = default;
};

/// View depths at which sub-frustums end: the first `count` entries (practical split scheme, Zhang et al. 2006).
std::array<double, kMostOfLight> split_depths(double near_m, const CascadeSettings&);
/// Corners of the camera's frustum between two view depths.
std::array<glm::dvec3, 8> frustum_corners(const shared::CameraRecord&, double begin_m, double end_m);
/// Furthest distance between any two of them.
double diameter_of(const std::array<glm::dvec3, 8>&);

/// A volume's extent. It stays the same while a camera turns or jitters, or nothing could be kept.
struct VolumeSize {
  double diameter_m = 0;  ///< Of the sub-frustum, rounded up.
  double texel_m = 0;
  double unit_m = 0;
  uint32_t side = 0;    ///< Texels, the guard band included.
  int guard_units = 0;  ///< Of depth, in the guard band.
  bool operator==(const VolumeSize&) const = default;
};
/// `former`: kept while the diameter is at most 1/64 less than its.
VolumeSize volume_size(double diameter_m, const CascadeSettings&, const std::optional<VolumeSize>& former);

class CascadePlanner {
 public:
  /// Records of the frame, `count` of each light. is_continued: false if what the device knows is of no use any more.
  std::span<const shared::CascadeRecord> plan(const shared::CameraRecord&, std::span<const CascadeLight>,
                                              const CascadeSettings&, bool is_continued);
  /// Texels of all maps of the last plan.
  uint32_t texels() const { return texels_; }

 private:
  struct Known {
    CascadeLight light;
    VolumeSize size;
    glm::ivec3 origin{0};
    bool operator==(const Known&) const = default;
  };
  CascadeSettings settings_;
  std::vector<Known> known_;
  std::vector<shared::CascadeRecord> records_;
  uint32_t texels_ = 0;
};

}  // namespace umbrage::cascades
