// Draws through the public interface alone.
#include "layered_rig.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "validation_layers.hpp"

namespace umbrage::test {

void LayeredTest::SetUpTestSuite() {
  gpu_ = take(app::GpuContext::create("", true));
  keep_validation_layers();
}
void LayeredTest::TearDownTestSuite() { gpu_.reset(); }
void LayeredTest::TearDown() { EXPECT_EQ(gpu().validation_messages(), 0u) << "see standard error"; }

bool LayeredTest::has(LayeredWriter writer) {
  const Capabilities enabled = gpu().headless().desc().enabled;
  switch (writer) {
    case LayeredWriter::geometry_invocations:
    case LayeredWriter::geometry_loop:
      return enabled.geometry_shader;
    case LayeredWriter::vertex_layer:
      return enabled.vertex_layer;
    case LayeredWriter::multiview:
      return enabled.multiview;
    case LayeredWriter::mesh:
      return enabled.mesh_shader;
    default:
      return true;
  }
}

Drawn LayeredTest::draw(LayeredScene& scene, LayeredPassSettings settings, const std::vector<LayeredView>& views,
                        uint32_t width, uint32_t height, uint32_t layers) {
  for (const LayeredView& view : views) layers = std::max(layers, view.layer + 1);
  const bool has_color = !settings.color_fragment.empty();
  settings.views = static_cast<uint32_t>(views.size());
  settings.color_format = has_color ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_UNDEFINED;
  auto images = take(app::LayerImages::create(gpu(), {.width = width,
                                                      .height = height,
                                                      .layers = layers,
                                                      .depth_format = settings.depth_format,
                                                      .color_format = settings.color_format}));
  const LayeredTarget target = take(LayeredTarget::create(scene, images.target()));
  LayeredPass pass = take(LayeredPass::create(scene, settings));
  take(scene.begin_frame(++serial_));
  const VkCommandBuffer commands = take(gpu().begin());
  scene.record(commands);
  const auto start = std::chrono::steady_clock::now();
  take(pass.prepare({.target = target, .views = views}));
  pass.record(commands);
  Drawn drawn{.width = width};
  drawn.cpu_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  take(gpu().submit_and_wait());
  drawn.splits = pass.splits();
  drawn.depth = take(images.read_depth(gpu()));
  if (has_color) {
    const auto bytes = take(images.read_color(gpu()));
    drawn.color.resize(bytes.size() / sizeof(float));
    std::memcpy(drawn.color.data(), bytes.data(), bytes.size());
  }
  return drawn;
}

Difference compare(const std::vector<float>& a, const std::vector<float>& b, float unit, uint32_t width, float clear) {
  Difference difference;
  if (a.size() != b.size()) throw std::runtime_error("pictures of different size");
  for (size_t i = 0; i < a.size(); ++i) {
    const bool in_a = a[i] != clear, in_b = b[i] != clear;
    difference.covered += in_a || in_b;
    difference.coverage += in_a != in_b;
    if (!in_a || !in_b) continue;
    difference.depth = std::max(difference.depth, std::abs(a[i] - b[i]));
    float lowest = a[i], highest = a[i];
    for (const size_t neighbour : {i - 1, i + 1, i - width, i + width}) {
      if (width == 0 || neighbour >= a.size()) continue;
      lowest = std::min(lowest, a[neighbour]), highest = std::max(highest, a[neighbour]);
    }
    difference.deeper += std::abs(a[i] - b[i]) > unit + (highest - lowest) / 32;
  }
  return difference;
}

std::string LayeredTest::scene_file(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(UMBRAGE_SCENES_DIR) / name;
  return std::filesystem::exists(file) ? file.string() : std::string();
}

}  // namespace umbrage::test
