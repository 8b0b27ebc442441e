// The math of shadow views: cube faces, taps across edges, spot and ortho frames, depth keys, bias pieces, solid angles, least depths.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <glm/gtc/constants.hpp>

#include "tests/unit/box_clipper.hpp"
#include "views/cube_face.shared.h"
#include "views/shadow_view.shared.h"
#include "views/view_math.shared.h"

namespace umbrage::test {
namespace {

using namespace shared;

std::vector<vec3> random_directions(size_t count) {
  std::mt19937 engine(7);
  std::normal_distribution<float> normal;
  std::vector<vec3> directions;
  while (directions.size() < count) directions.push_back({normal(engine), normal(engine), normal(engine)});
  return directions;
}

float determinant(const mat3& m) { return glm::determinant(m); }

float identity_error(const mat3& m) {
  const mat3 product = m * transpose(m);
  float error = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) error = max(error, abs(product[column][row] - (row == column ? 1.0f : 0.0f)));
  return error;
}

TEST(CubeFaces, OrientedAsInTheVulkanSpecification) {
  for (const vec3& p : random_directions(1000))
    for (uint face = 0; face < CubeFaceCount; ++face) {
      const vec3 c = face_coordinates(face, p);
      const Point expected = face_point(face, {p.x, p.y, p.z});
      ASSERT_EQ(vec3(expected.x, expected.y, expected.z), c);
      ASSERT_EQ(face_rotation(face) * p, c);
      ASSERT_EQ(face_coordinates(face, face_direction(face, p.x, p.y)), vec3(p.x, p.y, 1.0f));
    }
  for (uint face = 0; face < CubeFaceCount; ++face) EXPECT_EQ(determinant(face_rotation(face)), -1.0f);
}

TEST(CubeFaces, EveryDirectionFallsOnItsDeepestFace) {
  for (const vec3& p : random_directions(1000)) {
    const vec3 c = face_coordinates(face_of_direction(p), p);
    ASSERT_GE(c.z, max(abs(c.x), abs(c.y)));
  }
  EXPECT_EQ(face_of_direction({1, 1, 1}), 0u);
  EXPECT_EQ(face_of_direction({-1, 1, -1}), 1u);
  EXPECT_EQ(face_of_direction({0.5f, 1, 1}), 2u);
  EXPECT_EQ(face_of_direction({0.5f, -1, 1}), 3u);
  EXPECT_EQ(face_of_direction({0, 0, -2}), 5u);
  EXPECT_EQ(face_of_direction({0, 0, 0}), 0u);
  EXPECT_EQ(face_of_direction({-0.0f, 0, 0}), 0u);
}

TEST(CubeFaces, TexelsHoldTheirCentresAndClamp) {
  for (const uint resolution : {1u, 3u, 16u, 1024u, 8192u})
    for (uint texel = 0; texel < resolution; ++texel) {
      ASSERT_EQ(texel_of(texel_centre(texel, resolution), resolution), texel);
    }
  EXPECT_EQ(texel_of(0.0f, 16), 8u);
  EXPECT_EQ(texel_of(1.0f, 16), 15u);
  EXPECT_EQ(texel_of(-1.0f, 16), 0u);
  EXPECT_EQ(texel_of(std::numeric_limits<float>::infinity(), 16), 15u);
  EXPECT_EQ(texel_of(-std::numeric_limits<float>::infinity(), 16), 0u);
  EXPECT_EQ(texel_of(std::numeric_limits<float>::quiet_NaN(), 16), 0u);
}

TEST(CubeTaps, StayWithinAFaceAndKeepTheirDirectionBeyondIt) {
  for (uint face = 0; face < CubeFaceCount; ++face)
    for (float s = -3; s <= 3; s += 0.125f)
      for (float t = -3; t <= 3; t += 0.125f) {
        const CubeTap tap = cube_tap(face, s, t);
        ASSERT_LE(max(abs(tap.s), abs(tap.t)), 1.0f);
        const vec3 wanted = normalize(face_direction(face, s, t));
        const vec3 found = normalize(face_direction(tap.face, tap.s, tap.t));
        ASSERT_LT(distance(wanted, found), 1e-6f);
        ASSERT_TRUE(max(abs(s), abs(t)) > 1.0f || (tap.face == face && tap.s == s && tap.t == t));
      }
}

TEST(CubeTaps, HalfATexelBeyondAnEdgeIsTheNeighboursBorderTexel) {
  const uint resolution = 64;
  const float beyond = 1.0f + 1.0f / 64;
  for (uint face = 0; face < CubeFaceCount; ++face)
    for (uint texel = 0; texel < resolution; ++texel)
      for (uint edge = 0; edge < 4; ++edge) {
        const float along = texel_centre(texel, resolution), across = (edge & 1) != 0 ? beyond : -beyond;
        const CubeTap tap = edge < 2 ? cube_tap(face, across, along) : cube_tap(face, along, across);
        ASSERT_NE(tap.face, face);
        const uint x = texel_of(tap.s, resolution), y = texel_of(tap.t, resolution);
        ASSERT_TRUE(x == 0 || y == 0 || x == resolution - 1 || y == resolution - 1);
        // The way back from the centre of that texel, one texel outwards, ends within a texel of where it began.
        const vec3 back =
            face_coordinates(face, face_direction(tap.face, texel_centre(x, resolution), texel_centre(y, resolution)));
        const vec2 st = vec2(back.x, back.y) / back.z;
        ASSERT_LT(abs((edge < 2 ? st.y : st.x) - along), 2.0f / 64);
      }
}

TEST(SolidAngles, OfTexelsSumToTheSphereAndMatchTheExactOnes) {
  const auto corner = [](double x, double y) { return std::atan2(x * y, std::sqrt(x * x + y * y + 1)); };
  for (const uint resolution : {16u, 64u}) {
    double sum = 0, worst = 0;
    const double side = 2.0 / resolution;
    for (uint i = 0; i < resolution; ++i)
      for (uint j = 0; j < resolution; ++j) {
        const double x = i * side - 1, y = j * side - 1;
        const double exact = corner(x + side, y + side) - corner(x, y + side) - corner(x + side, y) + corner(x, y);
        const double found = texel_solid_angle(texel_centre(i, resolution), texel_centre(j, resolution), resolution);
        sum += 6 * found;
        worst = std::max(worst, std::abs(found / exact - 1));
      }
    EXPECT_LT(worst, resolution == 16 ? 4e-3 : 2.5e-4) << resolution;
    EXPECT_NEAR(sum, 4 * glm::pi<double>(), 3.2 / (resolution * resolution));
  }
}

TEST(SolidAngles, OfSpheres) {
  EXPECT_FLOAT_EQ(sphere_solid_angle(2, 1), 4 * Pi);
  EXPECT_FLOAT_EQ(sphere_solid_angle(1, 1), 4 * Pi);
  EXPECT_NEAR(sphere_solid_angle(1, 1.000001f), 2 * Pi, 2e-2f);
  for (const double ratio : {0.9, 0.1, 1e-3, 1e-6}) {
    const double exact = 2 * glm::pi<double>() * ratio * ratio / (1 + std::sqrt(1 - ratio * ratio));
    EXPECT_NEAR(sphere_solid_angle(static_cast<float>(ratio), 1) / exact, 1, 1e-6);
  }
}

TEST(ViewRotation, IsAFrameThatAgreesWithTheCubeFaces) {
  for (uint face = 0; face < CubeFaceCount; ++face)
    EXPECT_EQ(view_rotation(face_direction(face, 0, 0)), face_rotation(face));
  for (const vec3& direction : random_directions(1000))
    for (const float scale : {1e-30f, 1.0f, 1e30f}) {
      const mat3 rotation = view_rotation(direction * scale);
      ASSERT_LT(identity_error(rotation), 1e-6f);
      ASSERT_NEAR(determinant(rotation), -1, 1e-6f);
      ASSERT_LT(distance(rotation * normalize(direction), vec3(0, 0, 1)), 1e-6f);
    }
  for (const vec3& direction : {vec3(1e-6f, 1, 0), vec3(-3e-6f, -1, 2e-6f), vec3(1e-4f, 1, 0), vec3(0, -1, -1e-4f)}) {
    EXPECT_LT(identity_error(view_rotation(direction)), 1e-6f);
  }
  EXPECT_EQ(view_rotation({0, 0, 0}), face_rotation(5));
}

TEST(ViewRotation, IsContinuousAwayFromThePoles) {
  const float step = 1e-3f;
  for (float elevation = -1.5f; elevation <= 1.5f; elevation += 0.1f)
    for (float azimuth = 0; azimuth < 2 * Pi; azimuth += step) {
      const auto at = [&](float angle) {
        return view_rotation({cos(elevation) * cos(angle), sin(elevation), cos(elevation) * sin(angle)});
      };
      const mat3 a = at(azimuth), b = at(azimuth + step);
      for (int column = 0; column < 3; ++column) ASSERT_LT(distance(a[column], b[column]), 2 * step);
    }
}

TEST(SpotViews, HoldTheConeAndTheGuard) {
  EXPECT_TRUE(spot_is_one_view(glm::radians(65.0f)));
  EXPECT_FALSE(spot_is_one_view(glm::radians(65.1f)));
  for (const float outer : {0.01f, 0.5f, 1.1344f})
    for (const uint resolution : {16u, 1024u}) {
      const float rim = tan(outer) / spot_tangent(outer, resolution, 2);
      EXPECT_NEAR((1 - rim) * 0.5f * static_cast<float>(resolution), 2, 1e-3f);
    }
}

/// Boxes of every size around and beside an origin; some are flat or points.
struct RandomBox {
  vec3 lo, hi;
  RandomBox(const vec3& origin, int kind, std::mt19937& engine) {
    std::normal_distribution<float> normal;
    const auto random = [&] { return vec3(normal(engine), normal(engine), normal(engine)); };
    vec3 half_size = abs(random()) * exp(normal(engine) - 1);
    if (kind % 6 == 0) half_size[kind / 6 % 3] = 0;
    if (kind % 13 == 0) half_size = vec3(0);
    const vec3 centre = origin + exp(normal(engine)) * random();
    lo = centre - half_size, hi = centre + half_size;
  }
  vec3 at(const vec3& shares) const { return lo + (hi - lo) * shares; }
};

/// The least depth of a box's points, by `depth` of a point: at its corners, at the one nearest to the origin, and at random ones.
template <class Depth>
float least_of_points(const RandomBox& box, const vec3& origin, std::mt19937& engine, const Depth& depth) {
  std::uniform_real_distribution<float> unit(0, 1);
  float least = depth(clamp(origin, box.lo, box.hi));
  for (int corner = 0; corner < 8; ++corner)
    least = min(least, depth(box.at(vec3(corner & 1, corner >> 1 & 1, corner >> 2))));
  for (int point = 0; point < 200; ++point)
    least = min(least, depth(box.at({unit(engine), unit(engine), unit(engine)})));
  return least;
}

TEST(LeastDepths, AreThoseOfTheNearestPointOfABox) {
  std::mt19937 engine(13);
  std::normal_distribution<float> normal;
  int cut_off = 0;
  for (int i = 0; i < 3000; ++i) {
    const vec3 origin = 5.0f * vec3(normal(engine), normal(engine), normal(engine));
    const float near_m = i % 3 == 0 ? 0.7f : 0.02f;
    const RandomBox box(origin, i, engine);
    const float rounding = 2e-6f * (length(origin) + length(box.hi - box.lo) + 10);

    // The axis depth of whichever face a direction falls on.
    const float cube = least_of_points(box, origin, engine, [&](const vec3& p) {
      const vec3 r = p - origin;
      return face_coordinates(face_of_direction(r), r).z;
    });
    for (uint face = 0; face < CubeFaceCount; ++face) {
      const ShadowView view = perspective_view(origin, near_m, face_rotation(face), 1);
      ASSERT_NEAR(least_depth(view, ViewsCube, box.lo, box.hi), max(cube, near_m), rounding) << "box " << i;
    }
    cut_off += cube < near_m;

    const mat3 rotation = view_rotation(vec3(normal(engine), normal(engine), normal(engine)));
    const ShadowView spot = perspective_view(origin, near_m, rotation, 0.3f + 0.1f * float(i % 20));
    const float along = least_of_points(box, origin, engine, [&](const vec3& p) { return (rotation * (p - origin)).z; });
    ASSERT_NEAR(least_depth(spot, ViewsSpot, box.lo, box.hi), max(along, near_m), rounding) << "box " << i;

    const ShadowView ortho = ortho_view(transpose(rotation)[2], box.lo, box.hi, 64, 2);
    ASSERT_EQ(least_depth(ortho, ViewsOrtho, box.lo, box.hi), 1);
  }
  EXPECT_GT(cut_off, 100);
}

TEST(LeastDepths, TimesTheUnitTexelAreTexels) {
  // A step of one texel there is one texel of clip space.
  std::mt19937 engine(14);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 300; ++i) {
    const vec3 origin(normal(engine), normal(engine), normal(engine));
    const mat3 rotation = i % 3 == 0 ? face_rotation(static_cast<uint>(i / 3 % 6))
                                     : view_rotation(vec3(normal(engine), normal(engine), normal(engine)));
    const mat3 axes = transpose(rotation);
    const uint resolution = 16u << (i % 7);
    const vec3 at = origin + axes[2] * (0.5f + static_cast<float>(i % 8));
    const uint kind = i % 3 == 0 ? ViewsCube : i % 3 == 1 ? ViewsSpot : ViewsOrtho;
    const ShadowView view = kind == ViewsOrtho ? ortho_view(axes[2], at - 2.0f, at + 2.0f, resolution, 2)
                                               : perspective_view(origin, 0.02f, rotation, kind == ViewsCube ? 1 : 0.4f);
    const vec3 step = axes[0] * unit_texel_m(view, kind, resolution) * least_depth(view, kind, at, at);
    const vec4 here = view_clip_position(view, at), there = view_clip_position(view, at + step);
    const float texels = (there.x / there.w - here.x / here.w) * static_cast<float>(resolution) / 2;
    ASSERT_NEAR(texels, 1, 1e-4f * static_cast<float>(resolution) / 16) << kind;
  }
}

TEST(OrthoFits, HoldTheBoxAndTheGuardOnWholeTexels) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> place(-1, 1), magnitude(-2, 3);
  for (const vec3& direction : random_directions(500)) {
    const mat3 rotation = view_rotation(direction);
    const float scale = pow(10.0f, magnitude(engine));
    const vec3 centre = vec3(place(engine), place(engine), place(engine)) * scale * 10.0f;
    const vec3 half_size = abs(vec3(place(engine), place(engine), place(engine))) * scale;
    for (const uint resolution : {16u, 1024u}) {
      const OrthoFit fit = ortho_fit(rotation, centre - half_size, centre + half_size, resolution, 2);
      const vec2 index = fit.origin / fit.texel_m;
      ASSERT_EQ(index, floor(index));
      const float limit = 1 - 4.0f / static_cast<float>(resolution) * (1 - 1e-2f);
      for (int corner = 0; corner < 8; ++corner) {
        const vec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const vec4 clip = clip_ortho(rotation * (centre + half_size * sign), fit, resolution);
        ASSERT_LE(max(abs(clip.x), abs(clip.y)), limit);
        ASSERT_TRUE(clip.z >= 0 && clip.z <= 1) << clip.z;
      }
    }
  }
}

TEST(OrthoFits, MoveByWholeTexelsWithTheBox) {
  const mat3 rotation = view_rotation({0.3f, -1, 0.2f});
  const OrthoFit before = ortho_fit(rotation, {-10, 0, -10}, {10, 5, 10}, 512, 2);
  for (float shift = 0; shift < 1; shift += 0.013f) {
    const OrthoFit after = ortho_fit(rotation, vec3(-10 + shift, 0, -10), vec3(10 + shift, 5, 10), 512, 2);
    ASSERT_EQ(after.texel_m, before.texel_m);
    const vec2 texels = (after.origin - before.origin) / after.texel_m;
    ASSERT_EQ(texels, round(texels));
  }
  const OrthoFit point = ortho_fit(rotation, {3, 3, 3}, {3, 3, 3}, 16, 2);
  EXPECT_GT(point.texel_m, 0);
  EXPECT_GT(point.depth_max, point.depth_min);
}

TEST(DepthKeys, PerspectiveIsWhatTheDepthBufferHolds) {
  const float near_m = 0.05f;
  uint previous = std::numeric_limits<uint>::max();
  for (float depth = near_m; depth < 1e4f; depth *= 1.001f) {
    const uint key = depth_key_perspective(near_m, depth);
    ASSERT_GT(key, 0u);
    ASSERT_LT(key, previous) << "nearer is larger, at " << depth;
    previous = key;
    const vec4 clip = clip_perspective({0, 0, depth}, 1, near_m);
    ASSERT_EQ(key, floatBitsToUint(clip.z / clip.w));
    ASSERT_NEAR(depth_of_key_perspective(near_m, key), depth, depth_quantum_perspective(depth));
    const double here = double(near_m) / uintBitsToFloat(key), behind = double(near_m) / uintBitsToFloat(key - 1);
    ASSERT_LE(behind - here, depth_quantum_perspective(depth) * 1.000001);
  }
  EXPECT_EQ(depth_key_perspective(near_m, 0.01f), floatBitsToUint(1.0f));
}

TEST(BiasPieces, TexelsGrowWithDepth) {
  EXPECT_FLOAT_EQ(texel_size_m(10, 1, 1000), 0.02f);
  EXPECT_FLOAT_EQ(texel_size_m(10, 0.5f, 1000), 0.01f);
}

TEST(BiasPieces, ReceiverPlaneDepthIsWhereTheDirectionMeetsThePlane) {
  const vec3 receiver(4, -1, 0.5f);
  const uint face = face_of_direction(receiver);
  const vec3 c = face_coordinates(face, receiver);
  for (const vec3& any : random_directions(2000)) {
    const vec3 normal = dot(any, receiver) < 0 ? normalize(any) : -normalize(any);
    for (const float step : {-0.01f, 0.0f, 0.02f}) {
      const vec3 direction = face_direction(face, c.x / c.z + step, c.y / c.z - step);
      const float depth = receiver_plane_depth(normal, receiver, direction);
      const float own = dot(receiver, direction) / dot(direction, direction);
      ASSERT_TRUE(depth > 0 && depth <= 4 * own * 1.000001f);
      ASSERT_LT(depth == own ? 0.0f : abs(dot(normal, direction * depth - receiver)), 2e-5f);
      ASSERT_LT(step == 0.0f ? abs(depth - c.z) : 0.0f, 1e-2f * c.z) << dot(normal, receiver);
    }
  }
  // A floor seen at a grazing angle: beyond its horizon the receiver's own depth stands in.
  const vec3 floor_point(100, -1, 0);
  EXPECT_NEAR(receiver_plane_depth({0, 1, 0}, floor_point, {1, 0.01f, 0}), 100, 0.1f);
  EXPECT_NEAR(receiver_plane_depth({0, 1, 0}, floor_point, {1, 0, 0}), 100, 0.1f);
  EXPECT_NEAR(receiver_plane_depth({0, 1, 0}, floor_point, {1, -0.02f, 0}), 50, 1e-3f);
}

}  // namespace
}  // namespace umbrage::test
