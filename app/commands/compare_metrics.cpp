#include "commands/compare_metrics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "commands/error_shapes.hpp"
#include "reference/distance_transform.hpp"

namespace app {
namespace {

constexpr uint32_t band_px_least = 3;
constexpr uint8_t half_visible = 127;  // of 254
constexpr size_t worst_listed = 10;

double luminance(glm::vec3 color) { return 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b; }

/// Sums for √(mean difference²) / mean.
struct RelativeError {
  double squares = 0, sum = 0;
  uint64_t count = 0;
  void add(double value, double expected) {
    squares += (value - expected) * (value - expected);
    sum += expected;
    ++count;
  }
  double result() const {
    if (squares == 0) return 0;
    if (sum == 0) return std::numeric_limits<double>::infinity();
    return std::sqrt(squares / double(count)) / (sum / double(count));
  }
};

}  // namespace

PairCounts& PairCounts::operator+=(const PairCounts& other) {
  evaluated += other.evaluated;
  wrong_outside_band += other.wrong_outside_band;
  wrong_inside_band += other.wrong_inside_band;
  wrong_outside_texel_band += other.wrong_outside_texel_band;
  false_lit += other.false_lit;
  false_dark += other.false_dark;
  missing += other.missing;
  unexpected += other.unexpected;
  acne += other.acne;
  leak += other.leak;
  detached += other.detached;
  return *this;
}

CompareAccumulator::CompareAccumulator(const reference::SurfaceImage& image,
                                       const reference::EvaluationMargins& margins)
    : image_(image), margins_(margins) {
  const size_t pixels = size_t(image.width) * image.height;
  assert(image.positions.size() == 3 * pixels && image.normals.size() == 3 * pixels);
  luminance_.resize(pixels);
  luminance_traced_.resize(pixels);
  errors_.resize(pixels);
}

glm::vec3 CompareAccumulator::position(size_t pixel) const {
  return {image_.positions[3 * pixel], image_.positions[3 * pixel + 1], image_.positions[3 * pixel + 2]};
}

glm::vec3 CompareAccumulator::normal(size_t pixel) const {
  return {image_.normals[3 * pixel], image_.normals[3 * pixel + 1], image_.normals[3 * pixel + 2]};
}

void CompareAccumulator::add_light(uint32_t index, const std::string& name, const reference::Light& light,
                                   const LightPictures& pictures) {
  assert(pictures.visibility.size() == errors_.size() && pictures.traced.size() == errors_.size());
  assert(pictures.band_px.empty() || pictures.band_px.size() == errors_.size());
  const std::vector<uint32_t> distances =
      reference::squared_distances_to_other(pictures.traced, image_.width, image_.height);
  PairCounts counts;
  for (size_t pixel = 0; pixel < errors_.size(); ++pixel) {
    count_pixel(pixel, light, pictures, distances[pixel], counts);
  }
  if (counts.wrong_outside_texel_band > 0) {
    const ErrorShapes shapes = find_error_shapes(image_, errors_);
    counts.acne = shapes.acne;
    counts.leak = shapes.leak;
    counts.detached = shapes.detached;
  }
  lights_.push_back({index, name, counts});
}

void CompareAccumulator::count_pixel(size_t pixel, const reference::Light& light, const LightPictures& pictures,
                                     uint32_t squared_distance, PairCounts& counts) {
  using reference::Evaluation;
  errors_[pixel] = uint8_t(ErrorKind::not_evaluated);
  if (std::isnan(image_.positions[3 * pixel])) return;
  const Evaluation expected = reference::expected_evaluation(light, position(pixel), normal(pixel), margins_);
  const uint8_t visibility = pictures.visibility[pixel];
  if (visibility == reference::not_evaluated) {
    counts.missing += expected == Evaluation::required;
    return;
  }
  counts.unexpected += expected == Evaluation::forbidden;
  ++counts.evaluated;
  errors_[pixel] = uint8_t(ErrorKind::none);

  const bool lit = visibility >= half_visible, traced_lit = pictures.traced[pixel] == reference::visible;
  const double unshadowed = luminance(reference::irradiance(light, position(pixel), normal(pixel)));
  luminance_[pixel] += unshadowed * visibility / 254;
  luminance_traced_[pixel] += unshadowed * traced_lit;
  if (lit == traced_lit) return;

  const uint32_t texel_band_px =
      pictures.band_px.empty() ? band_px_least : std::max<uint32_t>(band_px_least, pictures.band_px[pixel]);
  counts.false_lit += lit;
  counts.false_dark += !lit;
  ++(squared_distance > band_px_least * band_px_least ? counts.wrong_outside_band : counts.wrong_inside_band);
  if (squared_distance > texel_band_px * texel_band_px) {
    ++counts.wrong_outside_texel_band;
    errors_[pixel] = uint8_t(lit ? ErrorKind::false_lit : ErrorKind::false_dark);
  }
}

CompareReport CompareAccumulator::report() const {
  CompareReport result;
  for (const LightCounts& light : lights_) {
    result.counts += light.counts;
    if (light.counts.wrong_outside_band > 0) result.worst.push_back(light);
  }
  std::stable_sort(result.worst.begin(), result.worst.end(), [](const LightCounts& a, const LightCounts& b) {
    return a.counts.wrong_outside_band > b.counts.wrong_outside_band;
  });
  if (result.worst.size() > worst_listed) result.worst.resize(worst_listed);

  RelativeError error;
  for (size_t pixel = 0; pixel < luminance_.size(); ++pixel) {
    if (!std::isnan(image_.positions[3 * pixel])) error.add(luminance_[pixel], luminance_traced_[pixel]);
  }
  result.luminance_rmse = error.result();
  return result;
}

double luminance_rmse(std::span<const float> a, std::span<const float> b) {
  assert(a.size() == b.size() && a.size() % 3 == 0);
  RelativeError error;
  for (size_t i = 0; i < a.size(); i += 3) {
    const double value = luminance({a[i], a[i + 1], a[i + 2]}), expected = luminance({b[i], b[i + 1], b[i + 2]});
    if (std::isfinite(value) && std::isfinite(expected)) error.add(value, expected);
  }
  return error.result();
}

}  // namespace app
