// Pictures as PNG files.
#include "commands/image_file.hpp"

#include <optional>
#include <vector>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace app {
namespace {

/// A frame number's place in a name.
struct NumberPlace {
  size_t begin = 0, end = 0;
  size_t digits = 0;  // At least this many, filled up with zeros.
};

std::optional<NumberPlace> find_place(const std::string& name, size_t from) {
  for (size_t begin = name.find('%', from); begin != std::string::npos; begin = name.find('%', begin + 1)) {
    if (name.compare(begin, 2, "%d") == 0) return NumberPlace{begin, begin + 2, 0};
    const bool has_width = name.compare(begin, 2, "%0") == 0 && begin + 3 < name.size() && name[begin + 2] >= '1' &&
                           name[begin + 2] <= '9' && name[begin + 3] == 'd';
    if (has_width) return NumberPlace{begin, begin + 4, static_cast<size_t>(name[begin + 2] - '0')};
  }
  return std::nullopt;
}

/// Where the encoder's output goes, and whether it arrived.
struct Sink {
  OutputFile& file;
  umbrage::Result<void> result;

  static void receive(void* context, void* data, int size) {
    Sink& sink = *static_cast<Sink*>(context);
    if (!sink.result) return;
    sink.result = sink.file.write(std::span(static_cast<const std::byte*>(data), static_cast<size_t>(size)));
  }
};

}  // namespace

umbrage::Result<void> write_png(Outputs& outputs, const std::filesystem::path& target, uint32_t width, uint32_t height,
                                std::span<const uint8_t> rgba) {
  std::vector<uint8_t> rgb;
  rgb.reserve(rgba.size() / 4 * 3);
  for (size_t i = 0; i + 3 < rgba.size(); i += 4) rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
  auto file = outputs.open(target);
  if (!file) return file.error();
  Sink sink{*file, {}};
  const int stride = static_cast<int>(width) * 3;
  if (!stbi_write_png_to_func(&Sink::receive, &sink, static_cast<int>(width), static_cast<int>(height), 3, rgb.data(),
                              stride))
    return umbrage::Error{umbrage::ErrorCode::out_of_memory, target.string() + ": no memory to encode the PNG"};
  if (!sink.result) return sink.result.error();
  return file->commit();
}

uint32_t count_number_places(const std::string& name) {
  uint32_t count = 0;
  for (auto place = find_place(name, 0); place; place = find_place(name, place->end)) ++count;
  return count;
}

std::string numbered_name(const std::string& name, uint32_t number) {
  const auto place = find_place(name, 0);
  if (!place) return name;
  std::string digits = std::to_string(number);
  if (digits.size() < place->digits) digits.insert(0, place->digits - digits.size(), '0');
  return name.substr(0, place->begin) + digits + name.substr(place->end);
}

}  // namespace app
