#include "test_scene.hpp"

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <stdexcept>

#include "clusters/camera.hpp"

namespace umbrage::test {

TestMesh sphere_mesh(uint32_t rings, uint32_t segments) {
  TestMesh mesh;
  for (uint32_t ring = 0; ring <= rings; ++ring) {
    for (uint32_t segment = 0; segment <= segments; ++segment) {
      const double polar = M_PI * ring / rings, around = 2 * M_PI * (segment % segments) / segments;
      mesh.positions.push_back({static_cast<float>(std::sin(polar) * std::cos(around)),
                                static_cast<float>(std::cos(polar)),
                                static_cast<float>(std::sin(polar) * std::sin(around))});
    }
  }
  for (uint32_t ring = 0; ring < rings; ++ring) {
    for (uint32_t segment = 0; segment < segments; ++segment) {
      const uint32_t a = ring * (segments + 1) + segment, b = a + segments + 1;
      if (ring > 0) mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1});
      if (ring + 1 < rings) mesh.indices.insert(mesh.indices.end(), {a, b + 1, b});
    }
  }
  return mesh;
}

TestMesh box_mesh() {
  TestMesh mesh;
  for (uint32_t i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  mesh.indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

TestMesh plane_mesh(uint32_t cells) {
  TestMesh mesh;
  for (uint32_t z = 0; z <= cells; ++z)
    for (uint32_t x = 0; x <= cells; ++x)
      mesh.positions.push_back({2.0f * float(x) / float(cells) - 1, 0, 2.0f * float(z) / float(cells) - 1});
  for (uint32_t z = 0; z < cells; ++z) {
    for (uint32_t x = 0; x < cells; ++x) {
      const uint32_t a = z * (cells + 1) + x, b = a + cells + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  }
  return mesh;
}

TestMesh masked_mesh() {
  TestMesh mesh = plane_mesh(4);
  for (const Vec3& p : mesh.positions) mesh.uvs.push_back({p.x * 0.5f + 0.5f, p.z * 0.5f + 0.5f});
  return mesh;
}

TestMesh mesh_of_levels(std::span<const TestMesh> parts, std::span<const LevelRange> levels,
                        std::span<const float> errors_m) {
  TestMesh mesh;
  mesh.level_errors_m.assign(errors_m.begin(), errors_m.end());
  for (size_t i = 0; i < parts.size(); ++i) {
    const TestMesh& part = parts[i];
    const auto first_vertex = static_cast<uint32_t>(mesh.positions.size());
    mesh.submeshes.push_back({.first_index = static_cast<uint32_t>(mesh.indices.size()),
                              .index_count = static_cast<uint32_t>(part.indices.size()),
                              .first_level = levels[i].first,
                              .last_level = levels[i].last});
    for (const uint32_t index : part.indices) mesh.indices.push_back(first_vertex + index);
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
  }
  return mesh;
}

TestMesh sphere_in_levels() {
  std::vector<TestMesh> parts;
  std::vector<LevelRange> ranges;
  std::vector<float> errors_m;
  for (uint32_t level = 0; level < 4; ++level) {
    const uint32_t rings = 32 >> level, segments = rings * 3 / 2;
    parts.push_back(sphere_mesh(rings, segments));
    ranges.push_back({level, level});
    // The finest is off from a true sphere itself, so this is more than what they are apart.
    errors_m.push_back(level == 0 ? 0 : static_cast<float>(1 - std::cos(M_PI / segments) * std::cos(M_PI / 2 / rings)));
  }
  return mesh_of_levels(parts, ranges, errors_m);
}

TestMesh finest_of(const TestMesh& mesh) {
  TestMesh finest = mesh;
  finest.indices.clear(), finest.submeshes.clear(), finest.level_errors_m.clear();
  for (const Submesh& submesh : mesh.submeshes) {
    if (submesh.first_level > 0) continue;
    finest.submeshes.push_back(
        {.first_index = static_cast<uint32_t>(finest.indices.size()), .index_count = submesh.index_count});
    const auto begin = mesh.indices.begin() + submesh.first_index;
    finest.indices.insert(finest.indices.end(), begin, begin + submesh.index_count);
  }
  return finest;
}

Affine affine(const glm::mat3& linear, const glm::vec3& translation) {
  Affine out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out.m[4 * row + column] = linear[column][row];
    out.m[4 * row + 3] = translation[row];
  }
  return out;
}

Affine random_affine(uint32_t seed, const glm::vec3& translation) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> size(0.2f, 1.2f);
  const glm::mat3 turn =
      glm::mat3_cast(glm::normalize(glm::quat(normal(engine), normal(engine), normal(engine), normal(engine))));
  glm::vec3 scale(size(engine), size(engine), size(engine));
  if (engine() % 4 == 0) scale.x = -scale.x;
  return affine(turn * glm::mat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z), translation);
}

glm::vec3 transform(const Affine& a, const Vec3& p) {
  return {a.m[0] * p.x + a.m[1] * p.y + a.m[2] * p.z + a.m[3], a.m[4] * p.x + a.m[5] * p.y + a.m[6] * p.z + a.m[7],
          a.m[8] * p.x + a.m[9] * p.y + a.m[10] * p.z + a.m[11]};
}

namespace {
LightDesc random_light(uint32_t index, std::mt19937& engine) {
  std::uniform_real_distribution<float> place(-12, 12), height(0.3f, 5), range(1, 6), cone(0.1f, 1.55f), unit(0, 1);
  std::normal_distribution<float> normal;
  LightDesc light;
  light.position = {place(engine), height(engine), place(engine)};
  light.direction = {normal(engine), -std::abs(normal(engine)) - 0.1f, normal(engine)};
  light.range_m = range(engine);
  light.host_index = index;
  if (index < 2) light.type = LightType::directional;
  if (index % 4 == 3) {
    light.type = LightType::spot;
    light.outer_cone_rad = cone(engine);
    light.inner_cone_rad = 0.5f * light.outer_cone_rad;
    light.range_m *= 2;
  }
  if (index % 11 == 5) light.casts_shadow = false;
  if (index % 7 == 6) light.max_resolution = 16;
  if (index % 5 == 4) light.light_mask = 1u << (index % 3);
  if (index % 9 == 8) light.near_m = 0.2f * light.range_m;
  return light;
}

CameraDesc camera_at(const glm::vec3& eye, const glm::vec3& target, uint32_t width, uint32_t height,
                     const glm::mat4& clip) {
  CameraDesc camera;
  const glm::mat4 view = glm::lookAt(eye, target, glm::vec3(0, 1, 0));
  std::memcpy(camera.view_from_world.m, &view, sizeof view);
  std::memcpy(camera.clip_from_view.m, &clip, sizeof clip);
  camera.width = width, camera.height = height;
  camera.normal_encoding = NormalEncoding::xyz_signed;
  return camera;
}

glm::mat4 perspective(uint32_t width, uint32_t height) {
  const float f = 1 / std::tan(0.5f * 1.0471976f);
  glm::mat4 clip(0);
  clip[0][0] = f * float(height) / float(width);
  clip[1][1] = -f;
  clip[2][3] = -1;
  return clip;
}
}  // namespace

TestScene mixed_scene(uint32_t instances, uint32_t lights, uint32_t seed) {
  TestScene scene;
  scene.meshes = {sphere_mesh(16, 24), box_mesh(), masked_mesh()};
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> place(-12, 12), height(0, 3);
  for (uint32_t i = 0; i < instances; ++i) {
    const glm::vec3 at(place(engine), height(engine), place(engine));
    TestInstance instance{.mesh = i % 3, .world_from_mesh = random_affine(seed + i, at)};
    if (i % 10 == 3) instance.mobility = Mobility::fixed;
    if (i % 6 == 5) instance.light_mask = 1u << (i % 3);
    if (i % 23 == 7) instance.casts = false;
    scene.instances.push_back(instance);
  }
  for (uint32_t i = 0; i < lights; ++i) scene.lights.push_back(random_light(i, engine));
  return scene;
}

CameraDesc perspective_camera(const glm::vec3& eye, const glm::vec3& target, uint32_t width, uint32_t height) {
  glm::mat4 clip = perspective(width, height);
  clip[3][2] = 0.1f;
  return camera_at(eye, target, width, height, clip);
}

CameraDesc finite_camera(const glm::vec3& eye, const glm::vec3& target, uint32_t width, uint32_t height, float far_m) {
  glm::mat4 clip = perspective(width, height);
  clip[2][2] = far_m / (0.1f - far_m);
  clip[3][2] = 0.1f * far_m / (0.1f - far_m);
  return camera_at(eye, target, width, height, clip);
}

CameraDesc orthographic_camera(const glm::vec3& eye, const glm::vec3& target, uint32_t width, uint32_t height,
                               float half_height, float far_m) {
  glm::mat4 clip(0);
  clip[0][0] = float(height) / float(width) / half_height;
  clip[1][1] = -1 / half_height;
  clip[2][2] = -1 / far_m;
  clip[3][3] = 1;
  return camera_at(eye, target, width, height, clip);
}

std::optional<Surface> balls_on_ground(const glm::vec3& origin, const glm::vec3& direction) {
  std::optional<Surface> nearest;
  const auto offer = [&](float t, const glm::vec3& normal) {
    if (t > 0 && (!nearest || t < nearest->t)) nearest = Surface{t, normal};
  };
  if (direction.y < 0) offer(-origin.y / direction.y, {0, 1, 0});
  const glm::vec4 balls[] = {{0, 1, 0, 1},       {4, 2, -3, 2},  {-5, 0.7f, 3, 0.7f},
                             {2, 0.4f, 6, 0.4f}, {-8, 3, -8, 3}, {9, 1.5f, 4, 1.5f}};
  for (const glm::vec4& ball : balls) {
    const glm::vec3 centre(ball), offset = origin - centre;
    const float a = glm::dot(direction, direction), b = glm::dot(direction, offset),
                c = glm::dot(offset, offset) - ball.w * ball.w;
    if (b * b < a * c) continue;
    const float t = (-b - std::sqrt(b * b - a * c)) / a;
    offer(t, (offset + direction * t) / ball.w);
  }
  if (nearest && nearest->t > 60) return std::nullopt;
  return nearest;
}

Receivers picture(const CameraDesc& desc, const Receiver& receiver) {
  auto made = clusters::camera_record(desc);
  if (!made) throw std::runtime_error(made.error().message);
  const shared::CameraRecord& camera = *made;
  const glm::vec4 k = camera.depth_to_t;
  Receivers out{desc.width, desc.height, {}, {}, {}, {}};
  for (uint32_t y = 0; y < desc.height; ++y) {
    for (uint32_t x = 0; x < desc.width; ++x) {
      const glm::vec2 ndc = shared::ndc_of_pixel(camera, glm::vec2(float(x) + 0.5f, float(y) + 0.5f));
      const glm::vec3 origin = shared::world_position(camera, ndc, 0), at_one = shared::world_position(camera, ndc, 1);
      const std::optional<Surface> hit = receiver(origin, at_one - origin);
      // t = (x + y d) / (z + w d), solved for d.
      const float depth = hit ? (k.x - hit->t * k.z) / (hit->t * k.w - k.y) : 0.0f;
      const bool seen = !shared::is_background(depth);
      const float t = seen ? shared::view_depth(camera, depth) : 0;
      out.depth.push_back(depth);
      out.normals.push_back(hit ? glm::vec4(hit->normal, 0) : glm::vec4(0));
      out.t.push_back(t);
      out.positions.push_back(seen ? shared::world_position(camera, ndc, t) : glm::vec3(0));
    }
  }
  return out;
}

}  // namespace umbrage::test
