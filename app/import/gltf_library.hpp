// tinygltf as the importer uses it: a parser of JSON into a typed model, with no file access and no image decoding.
#pragma once
// The implementation in gltf_library.cpp is compiled with the same switches.
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <string>
#include <string_view>
#include <vector>

#include "import/gltf_document.hpp"

namespace app::gltf {

struct BufferSource {
  std::string uri;  ///< Empty: the BIN chunk.
  uint64_t byte_length = 0;
};

struct ImageSource {
  std::string name, uri;
  int buffer_view = -1;
};

/// A document whose shape is checked. Its references (indices into lists) are not.
struct Model {
  tinygltf::Model parsed;   ///< Without buffers and images.
  size_t buffer_views = 0;  ///< Accessors whose bufferView is not below this have none.
  std::vector<BufferSource> buffers;
  std::vector<ImageSource> images;
};

/// Refuses other versions than 2.x and required extensions that the importer does not know.
Model parse_model(const Document&);

/// An extension of a model's object; nullptr: not there.
const tinygltf::Value* extension(const tinygltf::ExtensionMap&, const char* name);
/// A number of an extension, or the fallback where it is missing.
double number_of(const tinygltf::Value&, const char* key, double fallback);
/// Elements of an array of numbers of an extension; empty where it is missing.
std::vector<double> numbers_of(const tinygltf::Value&, const char* key);

/// A number of the file as a float; refused where it does not fit one.
float finite_float(double, std::string_view where);

}  // namespace app::gltf
