// A layered use drawn: its views in one pass, as one picture.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "import/scene.hpp"
#include "layered/layered_uses.hpp"

namespace app {

struct UsePictureDesc {
  LayeredUse use = LayeredUse::cube;
  umbrage::LayeredWriter writer = umbrage::LayeredWriter::vertex_layer;
  uint32_t width = 384, height = 384;  ///< Of one view; cube faces are squares of the height.
  std::string device;
  bool validate = false;
};

struct UsePicture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
  uint32_t views = 0, splits = 0;
};

/// Errors: unsupported (the device lacks what the writer needs), and those of the scene. With validate, any message is one.
umbrage::Result<UsePicture> draw_use(const Scene&, const Pose&, const UseScene&, const UsePictureDesc&);

}  // namespace app
