// How wrong shadows are: the renderer's visibility against the ray tracer's, light by light, summed up for `compare`.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reference/light.hpp"
#include "reference/ray_tracer.hpp"

namespace app {

/// Counts of pixel × light pairs. A pair is *evaluated* where the renderer's byte is not 255, and *wrong* where
/// (visibility ≥ 0.5) is not what the ray says. The *band* of a light is every pixel within 3 pixels (Euclidean) of
/// an evaluated pixel whose ray says the opposite. Its *texel band* reaches max(3, band_px) pixels, band_px being
/// twice the shadow texel's size there.
struct PairCounts {
  uint64_t evaluated = 0;
  uint64_t wrong_outside_band = 0;
  uint64_t wrong_inside_band = 0;
  uint64_t wrong_outside_texel_band = 0;
  uint64_t false_lit =
      0;  ///< Wrong and lit by the renderer, in or outside the bands; false_lit + false_dark = all wrong.
  uint64_t false_dark = 0;
  uint64_t missing = 0;     ///< Not evaluated though reference::expected_evaluation requires it: an error of its own.
  uint64_t unexpected = 0;  ///< Evaluated though it forbids it.
  // What an eye would call them, all of them wrong outside the texel band; error_shapes.hpp has the definitions.
  uint64_t acne = 0;
  uint64_t leak = 0;
  uint64_t detached = 0;

  PairCounts& operator+=(const PairCounts&);
  uint64_t wrong() const { return false_lit + false_dark; }
  /// count / evaluated; 0 where nothing was evaluated.
  double fraction(uint64_t count) const { return evaluated ? double(count) / double(evaluated) : 0; }
};

/// Bytes of one light, height × width each.
struct LightPictures {
  std::span<const uint8_t> visibility;  ///< 0…254 = visibility × 254, 255 = not evaluated.
  std::span<const uint8_t> band_px;     ///< Reach of the texel band; empty: that of the band everywhere.
  std::span<const uint8_t> traced;      ///< RayTracer::visibility for the same evaluated pairs.
};

struct LightCounts {
  uint32_t index = 0;  ///< In the order of visibility.npy.
  std::string name;
  PairCounts counts;
};

struct CompareReport {
  PairCounts counts;
  /// Root mean square, over all pixels that show something, of the difference in luminance between irradiance under
  /// the renderer's visibility and under the rays', divided by the mean under the rays'. Irradiance stands for the
  /// picture: Lambert's law on geometric normals, unit albedo, over the evaluated pairs, with the falloff of
  /// reference::irradiance.
  double luminance_rmse = 0;
  std::vector<LightCounts> worst;  ///< At most 10, most wrong_outside_band pairs first; those without any are left out.
};

/// Takes the lights one by one, so that no two lights' pictures are held together.
class CompareAccumulator {
 public:
  /// The image's spans outlive the accumulator.
  explicit CompareAccumulator(const reference::SurfaceImage& image, const reference::EvaluationMargins& = {});

  /// Preconditions: spans hold width × height bytes; traced is 255 exactly where visibility is 255 or the position NaN.
  void add_light(uint32_t index, const std::string& name, const reference::Light&, const LightPictures&);
  CompareReport report() const;

 private:
  void count_pixel(size_t pixel, const reference::Light&, const LightPictures&, uint32_t squared_distance, PairCounts&);
  glm::vec3 position(size_t pixel) const;
  glm::vec3 normal(size_t pixel) const;

  reference::SurfaceImage image_;
  reference::EvaluationMargins margins_;
  std::vector<double> luminance_, luminance_traced_;
  std::vector<uint8_t> errors_;  ///< Scratch of add_light: ErrorKind of each pixel outside the texel band.
  std::vector<LightCounts> lights_;
};

/// √(mean (Ya − Yb)²) / mean Yb of two linear RGB images, Y = relative luminance; pixels with anything not finite are
/// left out. 0 where they are equal, infinite where only the reference b is black. Precondition: equal sizes,
/// multiples of 3.
double luminance_rmse(std::span<const float> a, std::span<const float> b);

}  // namespace app
