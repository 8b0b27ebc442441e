// Strict readers of what stands on the command line: the whole text is the value, or an error says what was expected.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "umbrage/result.hpp"

namespace app {

struct Extent {
  uint32_t width = 1280, height = 720;
};

/// Both ends belong to the range.
struct IndexRange {
  uint32_t first = 0, last = 0;
};

/// An error of code invalid_argument.
umbrage::Error invalid(std::string message);
/// "a, b, c" for messages that list choices; long lists end in "… (n in all)".
std::string join_names(std::span<const std::string> names);

/// A finite decimal number, in [min, max].
umbrage::Result<double> parse_number(std::string_view text, double min = std::numeric_limits<double>::lowest(),
                                     double max = std::numeric_limits<double>::max());
/// Decimal digits only, in [min, max].
umbrage::Result<uint64_t> parse_count(std::string_view text, uint64_t min, uint64_t max);
/// "X,Y,Z", each finite as a float.
umbrage::Result<glm::vec3> parse_vec3(std::string_view text);
/// "X,Y,Z,RADIUS", the radius positive.
umbrage::Result<glm::vec4> parse_ball(std::string_view text);
/// "WxH", each in 1…16384.
umbrage::Result<Extent> parse_size(std::string_view text);
/// "0,5,10-20".
umbrage::Result<std::vector<IndexRange>> parse_index_list(std::string_view text);
/// The indices in ascending order, each once. Ranges that reach count or beyond are refused.
umbrage::Result<std::vector<uint32_t>> expand_indices(std::span<const IndexRange> ranges, uint32_t count);

}  // namespace app
