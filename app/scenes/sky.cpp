// The dome, seen from inside.
#include "scenes/sky.hpp"

#include <cmath>

namespace app {

using glm::vec2;
using glm::vec3;

void add_sky(MeshBuilder& builder, const SkyDome& dome, Detail detail) {
  const int around = detail == Detail::low ? 24 : 48, rings = detail == Detail::low ? 6 : 12;
  const auto point = [&](int step, int ring) {
    const float angle = 6.2831853f * static_cast<float>(step % around) / static_cast<float>(around);
    const float rise = 1.5707963f * static_cast<float>(ring) / static_cast<float>(rings);
    const float radius = dome.radius_m * std::cos(rise);
    return vec3{radius * std::sin(angle), dome.bottom_m + dome.rise_m * std::sin(rise), radius * std::cos(angle)};
  };
  std::vector<vec3> positions, normals;
  std::vector<vec2> uvs;
  std::vector<uint32_t> indices;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int step = 0; step <= around; ++step) {
      const vec3 p = point(step, ring);
      positions.push_back(p);
      normals.push_back(glm::normalize(-vec3(p.x, 0.7f * p.y, p.z)));
      uvs.push_back({static_cast<float>(step) / static_cast<float>(around),
                     1 - static_cast<float>(ring) / static_cast<float>(rings)});
    }
  }
  const auto at = [&](int step, int ring) { return static_cast<uint32_t>(ring * (around + 1) + step); };
  for (int ring = 0; ring < rings; ++ring) {
    for (int step = 0; step < around; ++step) {
      const std::array faces{at(step + 1, ring), at(step, ring),     at(step, ring + 1),
                             at(step + 1, ring), at(step, ring + 1), at(step + 1, ring + 1)};
      indices.insert(indices.end(), faces.begin(), ring + 1 == rings ? faces.begin() + 3 : faces.end());
    }
  }
  builder.surface(Mat::sky, positions, normals, uvs, indices);
}

}  // namespace app
