// Strict readers of command-line values.
#include "commands/parse.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace app {
namespace {

constexpr uint64_t kMaxSide = 16384;  // The largest image side that Vulkan devices commonly offer.
constexpr size_t kMaxNamesListed = 24;

std::string quoted(std::string_view text) { return std::string(1, '"').append(text) + '"'; }

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

/// The text up to the separator, which is removed from the front of rest with it.
std::string_view take_field(std::string_view& rest, char separator) {
  const size_t end = std::min(rest.find(separator), rest.size());
  const std::string_view field = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return field;
}

}  // namespace

umbrage::Error invalid(std::string message) {
  return umbrage::Error{umbrage::ErrorCode::invalid_argument, std::move(message)};
}

std::string join_names(std::span<const std::string> names) {
  std::string joined;
  for (size_t i = 0; i < std::min(names.size(), kMaxNamesListed); ++i) joined += (i ? ", " : "") + names[i];
  if (names.size() > kMaxNamesListed) joined += ", … (" + std::to_string(names.size()) + " in all)";
  return joined;
}

umbrage::Result<double> parse_number(std::string_view text, double min, double max) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return invalid(quoted(text) + " is not a finite number");
  if (value < min) return invalid("must be at least " + shortest(min) + ", is " + std::string(text));
  if (value > max) return invalid("must be at most " + shortest(max) + ", is " + std::string(text));
  return value;
}

umbrage::Result<uint64_t> parse_count(std::string_view text, uint64_t min, uint64_t max) {
  uint64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = code != std::errc::invalid_argument && end == text.data() + text.size();
  if (!is_whole) return invalid(quoted(text) + " is not a whole number");
  if (code != std::errc() || value < min || value > max)
    return invalid("must be " + std::to_string(min) + "…" + std::to_string(max) + ", is " + std::string(text));
  return value;
}

umbrage::Result<glm::vec3> parse_vec3(std::string_view text) {
  if (std::count(text.begin(), text.end(), ',') != 2) return invalid(quoted(text) + " is not X,Y,Z");
  std::string_view rest = text;
  glm::vec3 result(0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = parse_number(take_field(rest, ','), -1e30, 1e30);
    if (!value) return invalid(quoted(text) + " is not X,Y,Z: " + value.error().message);
    result[axis] = static_cast<float>(*value);
  }
  return result;
}

umbrage::Result<glm::vec4> parse_ball(std::string_view text) {
  const size_t comma = text.rfind(',');
  const auto center = parse_vec3(text.substr(0, comma));
  if (comma == std::string_view::npos || !center) return invalid(quoted(text) + " is not X,Y,Z,RADIUS");
  const auto radius = parse_number(text.substr(comma + 1), 1e-6, 1e6);
  if (!radius) return invalid(quoted(text) + " is not X,Y,Z,RADIUS: " + radius.error().message);
  return glm::vec4(*center, static_cast<float>(*radius));
}

umbrage::Result<Extent> parse_size(std::string_view text) {
  if (std::count(text.begin(), text.end(), 'x') != 1) return invalid(quoted(text) + " is not WxH, such as 1280x720");
  std::string_view rest = text;
  const auto width = parse_count(take_field(rest, 'x'), 1, kMaxSide);
  if (!width) return invalid("width of " + quoted(text) + ": " + width.error().message);
  const auto height = parse_count(rest, 1, kMaxSide);
  if (!height) return invalid("height of " + quoted(text) + ": " + height.error().message);
  return Extent{static_cast<uint32_t>(*width), static_cast<uint32_t>(*height)};
}

umbrage::Result<std::vector<IndexRange>> parse_index_list(std::string_view text) {
  std::vector<IndexRange> ranges;
  const auto fields = std::count(text.begin(), text.end(), ',') + 1;
  std::string_view rest = text;
  for (ptrdiff_t i = 0; i < fields; ++i) {
    std::string_view field = take_field(rest, ',');
    const bool is_range = field.find('-') != std::string_view::npos;
    const auto first = parse_count(take_field(field, '-'), 0, UINT32_MAX);
    if (!first) return invalid(quoted(text) + " is not a list such as 0,5,10-20: " + first.error().message);
    const auto last = is_range ? parse_count(field, 0, UINT32_MAX) : first;
    if (!last) return invalid(quoted(text) + " is not a list such as 0,5,10-20: " + last.error().message);
    if (*last < *first) return invalid(quoted(text) + ": a range must rise, such as 10-20");
    ranges.push_back({static_cast<uint32_t>(*first), static_cast<uint32_t>(*last)});
  }
  return ranges;
}

umbrage::Result<std::vector<uint32_t>> expand_indices(std::span<const IndexRange> ranges, uint32_t count) {
  std::vector<bool> chosen(count, false);
  for (const IndexRange& range : ranges) {
    if (range.last >= count)
      return invalid("there is no light " + std::to_string(range.last) + ": the frame has " + std::to_string(count) +
                     " lights, counted from 0");
    std::fill(chosen.begin() + range.first, chosen.begin() + range.last + 1, true);
  }
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < count; ++i)
    if (chosen[i]) indices.push_back(i);
  return indices;
}

}  // namespace app
