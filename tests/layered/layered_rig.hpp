// A device under validation that draws layered passes and hands back their layers.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <stdexcept>

#include "host/layer_images.hpp"
#include "host/layered_geometry.hpp"
#include "host/textures.hpp"

namespace umbrage::test {

constexpr std::array<LayeredWriter, 8> kAllWriters{LayeredWriter::traditional,   LayeredWriter::geometry_invocations,
                                                   LayeredWriter::geometry_loop, LayeredWriter::vertex_layer,
                                                   LayeredWriter::multiview,     LayeredWriter::mesh,
                                                   LayeredWriter::atlas,         LayeredWriter::compute};

template <class T>
T take(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}
inline void take(const Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

struct Drawn {
  uint32_t width = 0;
  std::vector<float> depth;
  std::vector<float> color;  ///< RGBA, with a colour format.
  uint32_t splits = 0;
  double cpu_ms = 0;  ///< prepare and record.
};

/// What two pictures of the same views may differ in.
struct Difference {
  size_t covered = 0;   ///< Texels that either covers.
  size_t coverage = 0;  ///< That only one covers.
  size_t deeper = 0;    ///< Where both do, by more than the unit and, with a width, 1/32 of the range around the texel.
  float depth = 0;      ///< Largest, where both do.
};
Difference compare(const std::vector<float>& a, const std::vector<float>& b, float unit, uint32_t width = 0,
                   float clear = 1.0f);

class LayeredTest : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void TearDown() override;
  static app::GpuContext& gpu() { return *gpu_; }

  /// False where the device lacks what the writer needs.
  static bool has(LayeredWriter);
  static LayeredScene scene(const app::LayeredArrays& arrays) { return take(arrays.create(gpu().headless().desc())); }
  /// One frame. The first color_fragment word list of settings makes it a colour pass (RGBA32F).
  static Drawn draw(LayeredScene&, LayeredPassSettings, const std::vector<LayeredView>&, uint32_t width,
                    uint32_t height, uint32_t layers = 0);
  /// The scene file below UMBRAGE_SCENES_DIR, or nothing: the test is to skip.
  static std::string scene_file(const std::string& name);

 private:
  inline static std::unique_ptr<app::GpuContext> gpu_;
  inline static uint64_t serial_ = 0;
};

}  // namespace umbrage::test
