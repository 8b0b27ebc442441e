// File access of the importer: whole files, GLB chunks, relative and data URIs.
#include "import/gltf_document.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "import/gltf_fault.hpp"
#include "import/gltf_limits.hpp"

namespace app::gltf {
namespace {

constexpr uint32_t glb_magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;  // "glTF", "JSON", "BIN"
constexpr size_t header_bytes = 12, chunk_header_bytes = 8;

uint32_t word_at(std::span<const uint8_t> bytes, size_t offset) {
  return uint32_t{bytes[offset]} | uint32_t{bytes[offset + 1]} << 8 | uint32_t{bytes[offset + 2]} << 16 |
         uint32_t{bytes[offset + 3]} << 24;
}

std::string_view as_text(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void split_glb(Document& document) {
  const std::span<const uint8_t> file = document.bytes;
  if (file.size() < header_bytes) refuse("GLB header: the file ends within it");
  if (const uint32_t version = word_at(file, 4); version != 2) {
    refuse_as(umbrage::ErrorCode::unsupported, "GLB header: version ", version, "; only version 2 is read");
  }
  const size_t length = word_at(file, 8);
  if (length > file.size()) {
    refuse("GLB header: its length is ", length, " bytes but the file has ", file.size(), ": it is truncated");
  }
  size_t chunks = 0;
  for (size_t offset = header_bytes; offset < length; ++chunks) {
    if (length - offset < chunk_header_bytes) refuse("GLB chunk ", chunks, ": the file ends within its header");
    const size_t chunk_bytes = word_at(file, offset);
    const uint32_t type = word_at(file, offset + 4);
    offset += chunk_header_bytes;
    if (chunk_bytes > length - offset) {
      refuse("GLB chunk ", chunks, ": its ", chunk_bytes, " bytes do not fit the ", length - offset,
             " left of the file");
    }
    if (chunk_bytes % 4 != 0) refuse("GLB chunk ", chunks, ": its length ", chunk_bytes, " is not a multiple of 4");
    if ((chunks == 0) != (type == json_chunk)) refuse("GLB chunk ", chunks, ": exactly the first chunk must be JSON");
    const std::span<const uint8_t> content = file.subspan(offset, chunk_bytes);
    if (chunks == 0) document.json = as_text(content);
    if (type == binary_chunk) {
      if (chunks != 1) refuse("GLB chunk ", chunks, ": only the second chunk may be BIN");
      document.binary = content;
    }
    offset += chunk_bytes;
  }
  if (chunks == 0) refuse("GLB: there is no JSON chunk");
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  return c == '/' ? 63 : -1;
}

std::vector<uint8_t> decode_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) refuse("data URI: a character that is not base64");
    bits = (bits << 6 | static_cast<uint32_t>(digit)) & 0xfffu;
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(static_cast<uint8_t>(bits >> bit_count));
    }
  }
  return bytes;
}

int hexadecimal_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string decode_percent(std::string_view uri) {
  std::string text;
  for (size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexadecimal_digit(uri[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal_digit(uri[i + 2]) : -1;
    if (low >= 0) i += 2;
    text.push_back(low >= 0 ? static_cast<char>(high * 16 + low) : uri[i]);
  }
  return text;
}

/// RFC 3986: letters, digits, + - . and then a colon.
bool has_scheme(std::string_view uri) {
  const size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.substr(0, colon).find_first_of("/?#%") == std::string_view::npos;
}

std::string shortened(const std::string& uri) { return uri.size() <= 80 ? uri : uri.substr(0, 77) + "..."; }

}  // namespace

std::vector<uint8_t> read_file(const std::filesystem::path& path, uint64_t max_bytes) {
  // Only regular files: a device or a pipe could block or never end.
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse("there is no file ", path.string());
  if (!std::filesystem::is_regular_file(status)) refuse(path.string(), " is not a regular file");
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) refuse(path.string(), ": ", error.message());
  std::ifstream stream(path, std::ios::binary);
  if (!stream) refuse(path.string(), " cannot be opened: check its permissions");
  std::vector<uint8_t> bytes(std::min(size, max_bytes));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<size_t>(stream.gcount()) != bytes.size()) refuse(path.string(), " could not be read to its end");
  return bytes;
}

std::vector<uint8_t> read_uri(const Document& document, const std::string& uri, uint64_t min_bytes,
                              uint64_t max_bytes) {
  std::vector<uint8_t> bytes;
  if (uri.starts_with("data:")) {
    const size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) {
      refuse("data URI: only base64 is read");
    }
    bytes = decode_base64(std::string_view(uri).substr(comma + 1));
    if (bytes.size() > max_bytes) bytes.resize(max_bytes);
  } else {
    const std::string relative = decode_percent(uri);
    if (has_scheme(uri) || std::filesystem::path(relative).is_absolute() || relative.find('\0') != std::string::npos) {
      refuse("URI \"", shortened(uri), "\": only paths relative to the file and data URIs are read");
    }
    bytes = read_file(document.folder / relative, max_bytes);
  }
  if (bytes.size() < min_bytes) {
    refuse("URI \"", shortened(uri), "\" has ", bytes.size(), " bytes where ", min_bytes, " are declared");
  }
  return bytes;
}

Document read_document(const std::filesystem::path& path) {
  Document document;
  document.folder = path.parent_path();
  document.bytes = read_file(path, max_file_bytes + 1);
  if (document.bytes.size() > max_file_bytes) refuse("larger than 4 GiB");
  document.json = as_text(document.bytes);
  if (document.bytes.size() >= 4 && word_at(document.bytes, 0) == glb_magic) split_glb(document);
  if (document.json.size() > max_json_bytes) refuse("more than ", max_json_bytes >> 20, " MiB of JSON");
  return document;
}

}  // namespace app::gltf
