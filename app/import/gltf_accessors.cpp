// Buffers, buffer views and accessors, with sparse ones, normalized integers and quantized attributes.
#include "import/gltf_accessors.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "import/gltf_fault.hpp"
#include "import/gltf_limits.hpp"

namespace app::gltf {

/// A checked accessor: reading elements 0 … count-1 stays inside the spans.
struct Accessors::Elements {
  std::span<const uint8_t> bytes;  ///< From the first element on; empty: all zero.
  size_t stride = 0, count = 0;
  uint32_t width = 1;
  int component_type = 0;
  bool normalized = false;
  size_t sparse_count = 0;
  int sparse_index_type = 0;
  std::span<const uint8_t> sparse_indices, sparse_values;
};

namespace {

bool is_unsigned(int component_type) {
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

bool allowed(int component_type, Numbers numbers) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return numbers != Numbers::indices;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return numbers != Numbers::floats;
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return numbers == Numbers::reals;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return numbers == Numbers::indices;
    default:
      return false;
  }
}

const char* description(Numbers numbers) {
  if (numbers == Numbers::floats) return "32-bit float";
  return numbers == Numbers::reals ? "32-bit float or 8- or 16-bit integer" : "unsigned integer";
}

size_t component_bytes(int component_type) {
  return static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(component_type)));
}

template <class T>
T load(const uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// Calls with a function that reads one component, so that the loop over elements is compiled per type.
template <class Use>
void with_reader(int component_type, Use&& use) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return use([](const uint8_t* b) { return load<int8_t>(b); }, 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return use([](const uint8_t* b) { return *b; }, 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return use([](const uint8_t* b) { return load<int16_t>(b); }, 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return use([](const uint8_t* b) { return load<uint16_t>(b); }, 65535.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return use([](const uint8_t* b) { return load<uint32_t>(b); }, 0.0f);
    default:
      return use([](const uint8_t* b) { return load<float>(b); }, 0.0f);
  }
}

uint32_t index_at(std::span<const uint8_t> bytes, int component_type, size_t i) {
  const uint8_t* at = bytes.data() + i * component_bytes(component_type);
  if (component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *at;
  return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? load<uint16_t>(at) : load<uint32_t>(at);
}

std::span<const uint8_t> tail_of(std::span<const uint8_t> view, uint64_t offset, uint64_t bytes, std::string_view where,
                                 std::string_view what) {
  if (offset > view.size() || bytes > view.size() - offset) {
    refuse(where, ": ", what, " needs ", bytes, " bytes from byte ", offset, " of a buffer view of ", view.size());
  }
  return view.subspan(offset);
}

}  // namespace

Accessors::Accessors(const Document& document, const Model& model)
    : document_(document), model_(model), loaded_(model.buffers.size()), file_bytes_(document.bytes.size()) {}

void Accessors::charge(uint64_t bytes, std::string_view where) {
  const uint64_t limit = decoded_bytes_base + decoded_per_file_byte * file_bytes_;
  if (bytes > limit - decoded_bytes_) {
    refuse(where, ": decodes to more than ", limit >> 20, " MiB, with what came before, from ", file_bytes_,
           " bytes: the file uses its data over and over or counts what is not there");
  }
  decoded_bytes_ += bytes;
}

std::span<const uint8_t> Accessors::buffer(int index, std::string_view where) {
  if (static_cast<size_t>(index) >= model_.buffers.size()) refuse(where, ": buffers[", index, "] is not in the file");
  const auto i = static_cast<size_t>(index);
  const BufferSource& source = model_.buffers[i];
  if (source.uri.empty()) {
    if (is_undefined(index)) refuse(place("buffers", i), ": has no uri, so its content is not in the file");
    if (source.byte_length > document_.binary.size()) {
      refuse("buffers[", i, "]: declares ", source.byte_length, " bytes; the BIN chunk has ", document_.binary.size());
    }
    return document_.binary.first(source.byte_length);
  }
  if (!loaded_[i]) {
    try {
      if (source.byte_length > max_file_bytes) refuse("larger than ", max_file_bytes >> 30, " GiB");
      loaded_[i] = read_uri(document_, source.uri, source.byte_length, source.byte_length);
    } catch (const Fault& fault) { refuse_as(fault.code, place("buffers", i), ": ", fault.what()); }
    // Data URIs are part of the document and were counted with it; a file counts once, however many buffers read it.
    const auto same = [&](size_t other) {
      return other != i && loaded_[other] && model_.buffers[other].uri == source.uri;
    };
    bool counted = source.uri.starts_with("data:");
    for (size_t other = 0; other < loaded_.size() && !counted; ++other) counted = same(other);
    if (counted) {
      charge(loaded_[i]->size(), where);
    } else {
      file_bytes_ += loaded_[i]->size();
    }
  }
  return *loaded_[i];
}

std::span<const uint8_t> Accessors::view(int buffer_view, std::string_view where) {
  if (buffer_view < 0 || static_cast<size_t>(buffer_view) >= model_.buffer_views) {
    refuse(where, ": bufferViews[", buffer_view, "] is not in the file");
  }
  const tinygltf::BufferView& view = model_.parsed.bufferViews[static_cast<size_t>(buffer_view)];
  const std::span<const uint8_t> bytes = buffer(view.buffer, place("bufferViews", static_cast<size_t>(buffer_view)));
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
    refuse("bufferViews[", buffer_view, "]: bytes ", view.byteOffset, " to ", view.byteOffset + view.byteLength,
           " are beyond the ", bytes.size(), " of buffers[", view.buffer, "]");
  }
  return bytes.subspan(view.byteOffset, view.byteLength);
}

const tinygltf::Accessor& Accessors::find(int accessor, std::string_view where) const {
  if (accessor < 0 || static_cast<size_t>(accessor) >= model_.parsed.accessors.size()) {
    refuse(where, ": accessors[", accessor, "] is not in the file");
  }
  return model_.parsed.accessors[static_cast<size_t>(accessor)];
}

bool Accessors::is_undefined(int buffer) const {
  const auto i = static_cast<size_t>(buffer);
  return i < model_.buffers.size() && model_.buffers[i].uri.empty() && (i != 0 || document_.binary.empty());
}

bool Accessors::has_data(int accessor, std::string_view where) const {
  const tinygltf::Accessor& source = find(accessor, where);
  const auto view_has_data = [&](int view) {
    return static_cast<size_t>(view) >= model_.buffer_views ||
           !is_undefined(model_.parsed.bufferViews[static_cast<size_t>(view)].buffer);
  };
  if (!view_has_data(source.bufferView)) return false;
  return !source.sparse.isSparse ||
         (view_has_data(source.sparse.indices.bufferView) && view_has_data(source.sparse.values.bufferView));
}

size_t Accessors::count(int accessor, std::string_view where) const { return find(accessor, where).count; }

uint32_t Accessors::width(int accessor, std::string_view where) const {
  return static_cast<uint32_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(find(accessor, where).type)));
}

Accessors::Elements Accessors::open(int accessor, uint32_t width, Numbers numbers, std::string_view where) {
  const tinygltf::Accessor& source = find(accessor, where);
  if (this->width(accessor, where) != width || !allowed(source.componentType, numbers)) {
    refuse(where, ": accessors[", accessor, "] has elements of ", this->width(accessor, where), " x componentType ",
           source.componentType, "; must be ", width, " x ", description(numbers));
  }
  Elements elements{
      .count = source.count, .width = width, .component_type = source.componentType, .normalized = source.normalized};
  const size_t element_bytes = width * component_bytes(source.componentType);
  if (static_cast<size_t>(source.bufferView) < model_.buffer_views) {
    const size_t stride = model_.parsed.bufferViews[static_cast<size_t>(source.bufferView)].byteStride;
    elements.stride = stride != 0 ? stride : element_bytes;
    if (elements.stride < element_bytes) {
      refuse(where, ": accessors[", accessor, "] has elements of ", element_bytes, " bytes every ", elements.stride);
    }
    const uint64_t bytes = source.count == 0 ? 0 : (source.count - 1) * elements.stride + element_bytes;
    elements.bytes = tail_of(view(source.bufferView, where), source.byteOffset, bytes, where,
                             place("accessors", static_cast<size_t>(accessor)));
  } else if (static_cast<size_t>(source.bufferView) > model_.buffer_views) {
    refuse("accessors[", accessor, "]: bufferViews[", source.bufferView, "] is not in the file");
  }
  if (source.sparse.isSparse) open_sparse(source, elements, where);
  return elements;
}

void Accessors::open_sparse(const tinygltf::Accessor& source, Elements& elements, std::string_view where) {
  const auto& sparse = source.sparse;
  if (!is_unsigned(sparse.indices.componentType)) refuse(where, ": sparse indices must be unsigned integers");
  elements.sparse_count = static_cast<size_t>(sparse.count);
  elements.sparse_index_type = sparse.indices.componentType;
  elements.sparse_indices =
      tail_of(view(sparse.indices.bufferView, where), static_cast<uint64_t>(sparse.indices.byteOffset),
              elements.sparse_count * component_bytes(sparse.indices.componentType), where, "sparse.indices");
  elements.sparse_values =
      tail_of(view(sparse.values.bufferView, where), static_cast<uint64_t>(sparse.values.byteOffset),
              elements.sparse_count * elements.width * component_bytes(source.componentType), where, "sparse.values");
  size_t next = 0;  // the smallest index that may follow
  for (size_t i = 0; i < elements.sparse_count; ++i) {
    const size_t index = index_at(elements.sparse_indices, elements.sparse_index_type, i);
    if (index < next || index >= elements.count) {
      refuse(where, ": sparse index ", index, " must increase and stay below the ", elements.count, " elements");
    }
    next = index + 1;
  }
}

template <class Number>
void Accessors::decode(const Elements& elements, Range range, std::span<Number> out, std::string_view where) {
  if (range.count > elements.count || range.first > elements.count - range.count) {
    refuse(where, ": needs element ", range.first + range.count - 1, " of ", elements.count);
  }
  with_reader(elements.component_type, [&](auto read, float one) {
    const size_t bytes = component_bytes(elements.component_type);
    const auto element = [&](const uint8_t* from, Number* to) {
      for (uint32_t c = 0; c < elements.width; ++c) {
        const auto value = static_cast<Number>(read(from + c * bytes));
        // Signed integers: -128 and -127 both mean -1.
        to[c] = elements.normalized && one > 0 ? static_cast<Number>(std::max(static_cast<float>(value) / one, -1.0f))
                                               : value;
      }
    };
    for (size_t i = 0; i < range.count && !elements.bytes.empty(); ++i) {
      element(elements.bytes.data() + (range.first + i) * elements.stride, out.data() + i * elements.width);
    }
    for (size_t i = 0; i < elements.sparse_count; ++i) {
      const size_t index = index_at(elements.sparse_indices, elements.sparse_index_type, i);
      if (index < range.first || index - range.first >= range.count) continue;
      element(elements.sparse_values.data() + i * elements.width * bytes,
              out.data() + (index - range.first) * elements.width);
    }
  });
}

std::vector<float> Accessors::floats(int accessor, uint32_t width, Numbers numbers, Range range,
                                     std::string_view where) {
  const Elements elements = open(accessor, width, numbers, where);
  charge(range.count * width * sizeof(float), where);
  std::vector<float> out(range.count * width);
  decode<float>(elements, range, out, where);
  for (size_t i = 0; i < out.size(); ++i) {
    if (!std::isfinite(out[i])) refuse(where, ": element ", range.first + i / width, " is not a finite number");
  }
  return out;
}

std::vector<float> Accessors::floats(int accessor, uint32_t width, Numbers numbers, std::string_view where) {
  return floats(accessor, width, numbers, {0, count(accessor, where)}, where);
}

std::vector<uint32_t> Accessors::integers(int accessor, uint32_t width, Range range, std::string_view where) {
  const Elements elements = open(accessor, width, Numbers::indices, where);
  if (elements.normalized) refuse(where, ": accessors[", accessor, "] holds indices and must not be normalized");
  charge(range.count * width * sizeof(uint32_t), where);
  std::vector<uint32_t> out(range.count * width);
  decode<uint32_t>(elements, range, out, where);
  return out;
}

}  // namespace app::gltf
