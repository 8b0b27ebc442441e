// Trees with every leaf as geometry: limbs fork a few times, leaves crowd around the ends of the twigs.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/props.hpp"

namespace app {
namespace {

using glm::vec3;

vec3 any_direction(Random& random) {
  const float z = random.around(1), angle = random.range(0, 6.2831853f), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), z, r * std::sin(angle)};
}

struct Foliage {
  Mat mat = Mat::leaf_green;
  int count = 24;       ///< Leaves of one clump.
  float radius = 0.9f;  ///< Of the clump.
  float leaf = 0.2f;    ///< Length of a leaf.
};

/// Leaves in a ball, lying along its surface as leaves that seek the light do.
void add_clump(MeshBuilder& builder, vec3 centre, const Foliage& foliage, Detail detail, Random& random) {
  const bool low = detail == Detail::low;
  const int count = low ? std::max(1, foliage.count / 9) : foliage.count;
  const float size = foliage.leaf * (low ? 2.7f : 1.0f);
  for (int i = 0; i < count; ++i) {
    const vec3 out = any_direction(random);
    const vec3 normal = glm::normalize(out + vec3(0, 0.7f, 0) + 0.5f * any_direction(random));
    vec3 along = glm::cross(normal, any_direction(random));
    along = glm::normalize(along + vec3(1e-4f, 0, 0));
    const vec3 across = glm::normalize(glm::cross(normal, along)) * size * 0.3f;
    const float length = size * random.range(0.8f, 1.25f);
    const vec3 position = centre + out * foliage.radius * std::sqrt(random.range(0.15f, 1.0f)) * vec3(1, 0.75f, 1);
    builder.leaf(foliage.mat, position, along * length, across, normal);
  }
}

struct Limb {
  vec3 from, direction;
  float length, radius;
  int forks;  ///< Generations of limbs still to come.
};

void grow(MeshBuilder& builder, const Limb& limb, const Foliage& foliage, Detail detail, Random& random) {
  const vec3 bend = any_direction(random) * 0.22f * limb.length;
  const vec3 middle = limb.from + limb.direction * limb.length * 0.5f + bend * 0.5f;
  const vec3 end = limb.from + limb.direction * limb.length + vec3(bend.x, 0, bend.z) * 0.4f;
  const int sides = limb.forks > 2 ? 8 : limb.forks == 2 ? 5 : 3;
  if (detail == Detail::full && limb.forks > 1) {
    builder.tube(Mat::bark, std::array{limb.from, middle, end},
                 std::array{limb.radius, limb.radius * 0.8f, limb.radius * 0.62f}, sides);
  } else if (detail == Detail::full) {
    builder.tube(Mat::bark, std::array{limb.from, end}, std::array{limb.radius, limb.radius * 0.6f}, sides);
  } else if (limb.forks > 1) {
    builder.tube(Mat::bark, std::array{limb.from, end}, std::array{limb.radius, limb.radius * 0.62f}, 4);
  }
  if (limb.forks == 0) {
    add_clump(builder, end, foliage, detail, random);
    return;
  }
  if (limb.forks == 1) add_clump(builder, end, foliage, detail, random);
  const int children = limb.forks > 2 ? 4 : 3;
  const float start = random.range(0, 6.2831853f);
  for (int i = 0; i < children; ++i) {
    const float angle =
        start + 6.2831853f * (static_cast<float>(i) + random.around(0.2f)) / static_cast<float>(children);
    const float lean = random.range(0.55f, 0.85f);
    const vec3 side = glm::normalize(glm::cross(limb.direction, vec3(std::cos(angle), 0.13f, std::sin(angle))));
    const vec3 direction = glm::normalize(limb.direction * std::cos(lean) + side * std::sin(lean) + vec3(0, 0.12f, 0));
    grow(builder, {end, direction, limb.length * random.range(0.6f, 0.78f), limb.radius * 0.6f, limb.forks - 1},
         foliage, detail, random);
  }
}

}  // namespace

void add_broad_tree(MeshBuilder& builder, Detail detail, Mat leaves, float height, uint32_t seed) {
  Random random(seed);
  const Foliage foliage{.mat = leaves, .count = 17, .radius = height * 0.13f, .leaf = 0.40f};
  grow(builder, {{0, -0.4f, 0}, {0, 1, 0}, height * 0.38f, height * 0.028f, 3}, foliage, detail, random);
}

void add_spruce(MeshBuilder& builder, Detail detail, uint32_t seed) {
  Random random(seed);
  const float height = 9.5f;
  builder.tube(Mat::bark, std::array{vec3(0, -0.4f, 0), vec3(0, height * 0.5f, 0), vec3(0, height, 0)},
               std::array{0.22f, 0.13f, 0.02f}, detail == Detail::low ? 4 : 7);
  const int whorls = detail == Detail::low ? 6 : 15;
  for (int w = 0; w < whorls; ++w) {
    const float t = static_cast<float>(w) / static_cast<float>(whorls - 1), y = 1.1f + (height - 1.3f) * t;
    const float reach = 2.5f * (1 - t) + 0.25f;
    const int arms = detail == Detail::low ? 5 : 9;
    for (int a = 0; a < arms; ++a) {
      const float angle = 6.2831853f *
                          (static_cast<float>(a) + 0.5f * static_cast<float>(w % 2) + random.around(0.25f)) /
                          static_cast<float>(arms);
      const vec3 out = glm::normalize(vec3(std::cos(angle), -0.42f + 0.5f * t, std::sin(angle)));
      const vec3 across = glm::normalize(glm::cross(out, vec3(0, 1, 0))), normal = glm::cross(across, out);
      if (detail == Detail::low) {
        builder.leaf(Mat::leaf_dark, {0, y, 0}, out * reach, across * reach * 0.35f, normal);
        continue;
      }
      const int sprays = std::max(2, static_cast<int>(reach * 2.4f));
      const float length = std::min(0.75f, 0.6f * reach + 0.2f);
      for (int s = 0; s < sprays; ++s) {
        const vec3 stem = vec3(0, y, 0) + out * (reach * (static_cast<float>(s) + 0.4f) / static_cast<float>(sprays));
        for (float side : {-0.8f, 0.8f}) {
          const vec3 fan = glm::normalize(out + across * side - vec3(0, 0.25f, 0));
          const vec3 fan_across = glm::normalize(glm::cross(fan, normal));
          builder.leaf(Mat::leaf_dark, stem, fan * length, fan_across * length * 0.4f, normal);
        }
      }
    }
  }
}

void add_poplar(MeshBuilder& builder, Detail detail, uint32_t seed) {
  Random random(seed);
  const float height = 12;
  builder.tube(Mat::bark, std::array{vec3(0, -0.4f, 0), vec3(0.1f, height * 0.5f, 0), vec3(0, height * 0.95f, 0)},
               std::array{0.24f, 0.15f, 0.03f}, detail == Detail::low ? 4 : 8);
  const int clumps = 40;
  for (int i = 0; i < clumps; ++i) {
    const float t = static_cast<float>(i) / (clumps - 1), y = 1.8f + (height - 2.1f) * t;
    const float width = 1.15f * std::sin(3.1415927f * std::pow(0.12f + 0.86f * t, 0.75f));
    const float angle = 2.399963f * static_cast<float>(i);
    const vec3 centre{width * 0.75f * std::cos(angle), y, width * 0.75f * std::sin(angle)};
    if (detail == Detail::full)
      builder.tube(Mat::bark, std::array{vec3(0, y - 0.7f, 0), centre}, std::array{0.04f, 0.015f}, 4);
    add_clump(builder, centre, {.mat = Mat::leaf_olive, .count = 19, .radius = 0.66f, .leaf = 0.34f}, detail, random);
  }
}

void add_fir(MeshBuilder& builder, Detail detail, float height, uint32_t seed) {
  Random random(seed);
  const bool low = detail == Detail::low;
  builder.tube(Mat::bark, std::array{vec3(0, -0.6f, 0), vec3(0, height * 0.9f, 0)},
               std::array{height * 0.022f, height * 0.004f}, low ? 3 : 5);
  // Skirts of hanging branches, with a ragged hem.
  const int tiers = low ? 4 : 8, points = low ? 5 : 7;
  for (int tier = 0; tier < tiers; ++tier) {
    const float t = static_cast<float>(tier) / static_cast<float>(tiers), hem = height * (0.09f + 0.84f * t);
    const float reach = height * 0.21f * std::pow(1 - t, 0.85f) + 0.12f, rise = height * (low ? 0.34f : 0.2f);
    const vec3 top{random.around(0.05f), std::min(hem + rise, height), random.around(0.05f)};
    const float start = random.range(0, 6.2831853f);
    std::vector<vec3> positions{top}, normals{{0, 1, 0}};
    std::vector<uint32_t> indices;
    for (int i = 0; i < 2 * points; ++i) {
      const float angle = start + 3.1415927f * static_cast<float>(i) / static_cast<float>(points);
      const float out = reach * (i % 2 ? random.range(0.5f, 0.66f) : random.range(0.85f, 1.1f));
      const vec3 side{std::cos(angle), 0, -std::sin(angle)};
      positions.push_back(side * out + vec3(0, hem + (i % 2 ? 0.25f : -0.12f) * reach, 0));
      normals.push_back(glm::normalize(side + vec3(0, 0.45f, 0)));
      const auto next = static_cast<uint32_t>((i + 1) % (2 * points));
      indices.insert(indices.end(), {0u, static_cast<uint32_t>(i) + 1, next + 1});
    }
    builder.surface(Mat::leaf_fir, positions, normals, {}, indices);
  }
}

void add_crown_tree(MeshBuilder& builder, Detail detail, Mat leaves, float height, uint32_t seed) {
  Random random(seed);
  const bool low = detail == Detail::low;
  const vec3 fork{0, height * 0.42f, 0};
  builder.tube(Mat::bark, std::array{vec3(0, -0.6f, 0), fork, vec3(0, height * 0.8f, 0)},
               std::array{height * 0.03f, height * 0.022f, height * 0.006f}, low ? 3 : 5);
  const int clumps = 13;
  for (int i = 0; i < clumps; ++i) {
    const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(clumps),
                angle = 2.399963f * static_cast<float>(i);
    const float out = height * 0.26f * std::sin(3.1415927f * (0.12f + 0.80f * t));
    const vec3 centre{out * std::cos(angle), height * (0.38f + 0.5f * t), out * std::sin(angle)};
    if (!low && i % 2 == 0)
      builder.tube(Mat::bark, std::array{vec3(0, centre.y - 0.14f * height, 0), centre},
                   std::array{height * 0.012f, height * 0.004f}, 3);
    add_clump(builder, centre, {.mat = leaves, .count = 16, .radius = height * 0.15f, .leaf = height * 0.095f}, detail,
              random);
  }
}

void add_bush(MeshBuilder& builder, Detail detail, uint32_t seed) {
  Random random(seed);
  for (int i = 0; i < 9; ++i) {
    const float angle = 2.399963f * static_cast<float>(i), out = 0.16f * std::sqrt(static_cast<float>(i)) * 1.4f;
    const vec3 centre{out * std::cos(angle), random.range(0.4f, 0.85f) - out * 0.3f, out * std::sin(angle)};
    if (detail == Detail::full)
      builder.tube(Mat::bark, std::array{vec3(0, -0.1f, 0), centre}, std::array{0.03f, 0.01f}, 4);
    add_clump(builder, centre,
              {.mat = i % 3 ? Mat::leaf_green : Mat::leaf_olive, .count = 22, .radius = 0.45f, .leaf = 0.19f}, detail,
              random);
  }
}

void add_planter(MeshBuilder& builder, Detail detail) {
  Random random(93);
  const bool low = detail == Detail::low;
  builder.lathe(Mat::plank, {{0.3f, 0}, {0.42f, 0.5f}, {0.38f, 0.5f}, {0.36f, 0.42f}}, low ? 5 : 12);
  builder.lathe(Mat::earth, {{0.36f, 0.42f}, {0, 0.45f}}, low ? 5 : 12);
  builder.tube(Mat::bark, std::array{vec3(0, 0.4f, 0), vec3(0.03f, 1.5f, 0.02f)}, std::array{0.04f, 0.025f},
               low ? 3 : 5);
  for (float y : {1.3f, 1.65f, 1.95f}) {
    add_clump(builder, {0, y, 0},
              {.mat = Mat::leaf_green, .count = 60, .radius = 0.55f - 0.25f * (y - 1.3f), .leaf = 0.2f}, detail,
              random);
  }
  if (!low) add_flowers(builder, {0, 0.55f, 0}, {0.3f, 0.08f, 0.3f}, 30, random);
}

}  // namespace app
