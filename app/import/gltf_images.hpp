// Images of a glTF file, decoded when a material first uses them.
#pragma once
#include <vector>

#include "import/gltf_accessors.hpp"
#include "import/scene.hpp"

namespace app::gltf {

class Images {
 public:
  Images(const Document& document, const Model& model, Accessors& accessors);
  /// Index into what take() returns. An image that is not there or cannot be decoded (PNG and JPEG are) is refused.
  int use(int image, std::string_view where);
  std::vector<Image> take() { return std::move(decoded_); }

 private:
  const Document& document_;
  const Model& model_;
  Accessors& accessors_;
  std::vector<int> decoded_index_;  ///< Per image of the file; -1: not used so far.
  std::vector<Image> decoded_;
  uint64_t bytes_ = 0;
};

}  // namespace app::gltf
