#include "reference/distance_transform.hpp"

#include <algorithm>
#include <cassert>

namespace reference {
namespace {

/// Scratch of one line; lines is the longest that will come.
struct Line {
  explicit Line(size_t length) : input(length), apexes(length), starts(length) {}
  std::vector<uint32_t> input;
  std::vector<uint32_t> apexes;  ///< Of the parabolas on the lower envelope, from left to right.
  std::vector<int64_t> starts;   ///< First pixel at which each of them is the lowest.
};

/// First integer x > left at which the parabola with apex `right` lies no higher than that of `left`.
int64_t overtakes_at(const std::vector<uint32_t>& input, int64_t left, int64_t right) {
  const int64_t height = (int64_t(input[size_t(right)]) + right * right) - (int64_t(input[size_t(left)]) + left * left);
  const int64_t width = 2 * (right - left);
  return height >= 0 ? (height + width - 1) / width : -(-height / width);
}

/// min over x' of input[x'] + (x − x')², written to output with the given stride.
void transform_line(Line& line, size_t length, uint32_t* output, size_t stride) {
  size_t count = 0;
  for (size_t x = 0; x < length; ++x) {
    if (line.input[x] == no_distance) continue;
    int64_t start = 0;
    while (count > 0) {
      start = overtakes_at(line.input, line.apexes[count - 1], int64_t(x));
      if (start > line.starts[count - 1]) break;
      --count;
    }
    if (count == 0) start = 0;
    if (start >= int64_t(length)) continue;
    line.apexes[count] = uint32_t(x);
    line.starts[count++] = start;
  }
  size_t lowest = 0;
  for (size_t x = 0; x < length; ++x) {
    if (count == 0) {
      output[x * stride] = no_distance;
      continue;
    }
    while (lowest + 1 < count && line.starts[lowest + 1] <= int64_t(x)) ++lowest;
    const int64_t offset = int64_t(x) - line.apexes[lowest];
    output[x * stride] = line.input[line.apexes[lowest]] + uint32_t(offset * offset);
  }
}

struct Rectangle {
  uint32_t left = 0, top = 0, right = 0, bottom = 0;  // half-open
};

Rectangle used_area(std::span<const uint8_t> values, uint32_t width, uint32_t height) {
  Rectangle area{width, height, 0, 0};
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      if (values[size_t(y) * width + x] > 1) continue;
      area.left = std::min(area.left, x), area.right = std::max(area.right, x + 1);
      area.top = std::min(area.top, y), area.bottom = y + 1;
    }
  }
  return area;
}

}  // namespace

std::vector<uint32_t> squared_distances(std::span<const uint8_t> marks, uint32_t width, uint32_t height) {
  assert(marks.size() == size_t(width) * height && width < 32768 && height < 32768);
  std::vector<uint32_t> result(marks.size());
  Line line(std::max(width, height));
  for (uint32_t y = 0; y < height; ++y) {
    const size_t row = size_t(y) * width;
    for (uint32_t x = 0; x < width; ++x) line.input[x] = marks[row + x] ? 0 : no_distance;
    transform_line(line, width, &result[row], 1);
  }
  for (uint32_t x = 0; x < width; ++x) {
    for (uint32_t y = 0; y < height; ++y) line.input[y] = result[size_t(y) * width + x];
    transform_line(line, height, &result[x], width);
  }
  return result;
}

std::vector<uint32_t> squared_distances_to_other(std::span<const uint8_t> values, uint32_t width, uint32_t height) {
  assert(values.size() == size_t(width) * height);
  std::vector<uint32_t> result(values.size(), no_distance);
  const Rectangle area = used_area(values, width, height);
  if (area.right <= area.left) return result;
  const uint32_t columns = area.right - area.left, rows = area.bottom - area.top;
  std::vector<uint8_t> marks(size_t(columns) * rows);
  for (const uint8_t value : {uint8_t(0), uint8_t(1)}) {
    const auto at = [&](uint32_t x, uint32_t y) { return size_t(y + area.top) * width + x + area.left; };
    for (uint32_t y = 0; y < rows; ++y) {
      for (uint32_t x = 0; x < columns; ++x) marks[size_t(y) * columns + x] = values[at(x, y)] == 1 - value;
    }
    if (std::find(marks.begin(), marks.end(), uint8_t(1)) == marks.end()) continue;
    const std::vector<uint32_t> distances = squared_distances(marks, columns, rows);
    for (uint32_t y = 0; y < rows; ++y) {
      for (uint32_t x = 0; x < columns; ++x) {
        if (values[at(x, y)] == value) result[at(x, y)] = distances[size_t(y) * columns + x];
      }
    }
  }
  return result;
}

}  // namespace reference
