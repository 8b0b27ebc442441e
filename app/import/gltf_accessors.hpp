// Numbers out of buffers: every accessor is checked against the bytes that are there before anything is allocated for
// it.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/gltf_library.hpp"

namespace app::gltf {

/// What an accessor's components may be for a use.
enum class Numbers : uint8_t {
  floats,   ///< 32-bit floats.
  reals,    ///< Also 8- and 16-bit integers, normalized or (KHR_mesh_quantization) not.
  indices,  ///< Unsigned integers.
};

/// Elements of an accessor.
struct Range {
  size_t first = 0, count = 0;
};

class Accessors {
 public:
  Accessors(const Document& document, const Model& model);

  /// False: the accessor lies in a buffer without a uri, whose content glTF leaves to extensions. where names who asks.
  bool has_data(int accessor, std::string_view where) const;
  /// Elements of an accessor.
  size_t count(int accessor, std::string_view where) const;
  /// Components of an element: 1 … 16.
  uint32_t width(int accessor, std::string_view where) const;
  /// Elements of a range as floats, all finite; the accessor must have this many components.
  std::vector<float> floats(int accessor, uint32_t width, Numbers, Range, std::string_view where);
  std::vector<float> floats(int accessor, uint32_t width, Numbers, std::string_view where);
  template <int Width>
  std::vector<glm::vec<Width, float>> vectors(int accessor, Numbers, Range, std::string_view where);
  /// Unsigned integers, one after the other.
  std::vector<uint32_t> integers(int accessor, uint32_t width, Range, std::string_view where);

  /// The bytes of a buffer view, checked. Valid while this object lives.
  std::span<const uint8_t> view(int buffer_view, std::string_view where);
  /// Counts memory about to be filled from the file against the limit.
  void charge(uint64_t bytes, std::string_view where);

 private:
  struct Elements;
  const tinygltf::Accessor& find(int accessor, std::string_view where) const;
  Elements open(int accessor, uint32_t width, Numbers, std::string_view where);
  void open_sparse(const tinygltf::Accessor&, Elements&, std::string_view where);
  bool is_undefined(int buffer) const;
  std::span<const uint8_t> buffer(int index, std::string_view where);
  template <class Number>
  void decode(const Elements&, Range, std::span<Number> out, std::string_view where);

  const Document& document_;
  const Model& model_;
  std::vector<std::optional<std::vector<uint8_t>>> loaded_;  ///< Per buffer with a URI, once it was asked for.
  uint64_t file_bytes_ = 0, decoded_bytes_ = 0;
};

template <int Width>
std::vector<glm::vec<Width, float>> Accessors::vectors(int accessor, Numbers numbers, Range range,
                                                       std::string_view where) {
  const std::vector<float> flat = floats(accessor, Width, numbers, range, where);
  std::vector<glm::vec<Width, float>> elements(range.count);
  for (size_t i = 0; i < range.count; ++i) {
    for (int c = 0; c < Width; ++c) elements[i][c] = flat[i * Width + static_cast<size_t>(c)];
  }
  return elements;
}

}  // namespace app::gltf
