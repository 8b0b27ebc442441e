// Visibility by rays cast at every triangle, where it does not depend on a texel or three.
#pragma once
#include "test_scene.hpp"

namespace umbrage::test {

struct Triangle {
  glm::dvec3 a, b, c;
};
std::vector<Triangle> triangles_of(const TestScene&);

enum class Answer { lit, dark, open };
/// What rays to everything within three texels of the point say; open: not the same. Suns are 60 m away.
Answer answer_of(const std::vector<Triangle>&, const LightDesc&, const glm::dvec3& p, double texel_m);

}  // namespace umbrage::test
