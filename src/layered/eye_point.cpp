// The point that a projection sends to x = y = w = 0 is where all its lines of sight meet. Its sign as the alternating product
// of those rows also tells which way triangles wind on screen: det(x, y, w of three vertices) = normal · (eye - vertex).
#include "layered/eye_point.hpp"

#include <array>
#include <cmath>

namespace umbrage::layered {

EyePoint eye_point(const Mat4& matrix, DepthOrder order) {
  using Row = std::array<double, 4>;
  const auto row = [&](int r) { return Row{matrix.m[r], matrix.m[4 + r], matrix.m[8 + r], matrix.m[12 + r]}; };
  const Row x = row(0), y = row(1), z = row(2), w = row(3);
  const auto minor = [&](int skipped) {
    std::array<int, 3> c{};
    for (int i = 0, at = 0; i < 4; ++i)
      if (i != skipped) c[static_cast<size_t>(at++)] = i;
    const auto at = [&](const Row& r, int i) { return r[static_cast<size_t>(c[static_cast<size_t>(i)])]; };
    return at(x, 0) * (at(y, 1) * at(w, 2) - at(y, 2) * at(w, 1)) -
           at(x, 1) * (at(y, 0) * at(w, 2) - at(y, 2) * at(w, 0)) +
           at(x, 2) * (at(y, 0) * at(w, 1) - at(y, 1) * at(w, 0));
  };
  std::array<double, 4> eye{minor(0), -minor(1), minor(2), -minor(3)};
  const double reach = std::sqrt(eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2]);
  constexpr double kFar = 1e7;  // farther than float positions resolve: the view is parallel
  const bool is_point = std::abs(eye[3]) * kFar > reach;
  double sign = 1;
  if (is_point) {
    sign = eye[3] < 0 ? -1 : 1;
  } else {
    const double deeper = z[0] * eye[0] + z[1] * eye[1] + z[2] * eye[2];
    const bool points_away = order == DepthOrder::smaller_is_nearer ? deeper > 0 : deeper < 0;
    sign = points_away ? -1 : 1;
  }
  const double scale = sign / (is_point ? std::abs(eye[3]) : reach > 0 ? reach : 1);
  EyePoint out;
  out.eye = {static_cast<float>(eye[0] * scale), static_cast<float>(eye[1] * scale), static_cast<float>(eye[2] * scale),
             is_point ? 1.0f : 0.0f};
  out.is_mirrored = sign < 0;
  return out;
}

}  // namespace umbrage::layered
