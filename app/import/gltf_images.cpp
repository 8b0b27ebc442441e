// PNG and JPEG, the two formats of glTF, through stb_image.
#include "import/gltf_images.hpp"

#include <cstring>
#include <limits>
#include <memory>

#include "import/gltf_fault.hpp"
#include "import/gltf_limits.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace app::gltf {
namespace {

static_assert(STBI_MAX_DIMENSIONS == max_image_side);

Image decode(std::span<const uint8_t> bytes, uint64_t bytes_so_far) {
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max())) refuse("larger than 2 GiB");
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
    refuse("not a PNG or JPEG file, or one with more than ", max_image_side, " pixels a side (", stbi_failure_reason(),
           ")");
  }
  if (width > max_image_side || height > max_image_side) {
    refuse(width, " x ", height, " pixels; at most ", max_image_side, " a side are read");
  }
  const uint64_t rgba_bytes = uint64_t{4} * static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  if (rgba_bytes + bytes_so_far > max_image_bytes) {
    refuse("with it the images take more than ", max_image_bytes >> 30, " GiB: use smaller ones");
  }
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), &stbi_image_free);
  if (!pixels) refuse("cannot be decoded (", stbi_failure_reason(), ")");
  Image image{.width = static_cast<uint32_t>(width), .height = static_cast<uint32_t>(height)};
  image.rgba.assign(pixels.get(), pixels.get() + rgba_bytes);
  return image;
}

}  // namespace

Images::Images(const Document& document, const Model& model, Accessors& accessors)
    : document_(document), model_(model), accessors_(accessors), decoded_index_(model.images.size(), -1) {}

int Images::use(int image, std::string_view where) {
  if (static_cast<size_t>(image) >= model_.images.size()) refuse(where, ": images[", image, "] is not in the file");
  const auto i = static_cast<size_t>(image);
  if (decoded_index_[i] >= 0) return decoded_index_[i];
  const ImageSource& source = model_.images[i];
  const std::string name = place("images", i);
  try {
    if (source.uri.empty() && source.buffer_view < 0) refuse("has neither a uri nor a bufferView");
    std::vector<uint8_t> file;
    std::span<const uint8_t> bytes;
    if (source.uri.empty()) {
      bytes = accessors_.view(source.buffer_view, name);
    } else {
      file = read_uri(document_, source.uri, 0, max_file_bytes);
      bytes = file;
    }
    decoded_.push_back(decode(bytes, bytes_));
  } catch (const Fault& fault) {
    refuse_as(fault.code, name, source.uri.empty() || source.uri.starts_with("data:") ? "" : " (" + source.uri + ")",
              ": ", fault.what());
  }
  bytes_ += decoded_.back().rgba.size();
  decoded_.back().name = source.name.empty() && !source.uri.starts_with("data:") ? source.uri : source.name;
  decoded_index_[i] = static_cast<int>(decoded_.size()) - 1;
  return decoded_index_[i];
}

}  // namespace app::gltf
