// The levels of directional lights as the device placed them, against the reference.
#pragma once
#include "pair_rig.hpp"
#include "reference/sun_levels.hpp"

namespace umbrage::test {

class SunCheck {
 public:
  /// casters: box around all.
  SunCheck(const DeviceMaps& maps, const shared::Box& casters);

  reference::SunPlane plane(const shared::LightRecord&) const;
  /// Place of a map: its level, finest first.
  uint32_t place(const shared::MapRecord&) const;
  /// Texels of a map, counted from the world's origin.
  reference::PlaneWindow window(const shared::MapRecord&) const;

  /// A sun's windows lie on the plane's texels and hold what they must, are no larger than that, and each pair has the finest map
  /// that it may. False: rounding decides.
  bool expect_maps(uint32_t slot, const std::vector<uint32_t>& pairs, const FrameSettings&) const;

 private:
  void expect_window(const shared::MapRecord&, const reference::PlaneRect& asked, uint32_t most) const;
  const DeviceMaps& maps_;
  reference::Box casters_;
};

}  // namespace umbrage::test
