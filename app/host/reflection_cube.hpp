// What a mirror ball shows: a cube map around its middle, drawn by layered passes and lit with umbrage's shadows. Each face is a
// camera of the shadow system, so that the surfaces seen in the mirror are receivers like those of the picture.
#pragma once
#include <array>
#include <memory>
#include <optional>

#include "host/layer_images.hpp"
#include "host/layered_geometry.hpp"
#include "host/mirror_ball.hpp"
#include "host/shaders/host.shared.h"
#include "host/textures.hpp"
#include "umbrage/frame.hpp"

namespace app {

class ReflectionCube {
 public:
  static constexpr uint32_t kFaces = 6;
  static constexpr uint32_t kSide = 256;  ///< Texels.

  /// Skinned and morphed meshes stay in the mirror as they are posed here. textures outlives it.
  static umbrage::Result<std::unique_ptr<ReflectionCube>> create(GpuContext&, const Scene&, const Pose&,
                                                                 const TextureTable&, const MirrorBall&,
                                                                 float scene_diagonal_m);
  const MirrorBall& ball() const { return ball_; }
  /// Faces as umbrage's cameras, with the ids first, first + 1, …
  std::array<umbrage::CameraDesc, kFaces> cameras(uint32_t first) const;
  /// Takes over the transforms of what moves.
  umbrage::Result<void> begin_frame(const Pose&, uint64_t serial);
  /// Depth of the faces, for umbrage to read.
  void record_depth(const GpuContext&, VkCommandBuffer);
  /// Their colours, after shadows: the host's frame, and umbrage's of each face.
  void record_color(const GpuContext&, VkCommandBuffer, VkDeviceAddress frame,
                    const std::array<VkDeviceAddress, kFaces>& shadows);
  /// A cube map, once recorded.
  VkDescriptorImageInfo image() const {
    return {sampler_.get(), color_view_.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  }

 private:
  /// An image array and what draws into all of its layers.
  struct Layers {
    LayerImages images;
    umbrage::LayeredTarget target;
    umbrage::LayeredPass pass;
  };
  ReflectionCube(const MirrorBall& ball, LayeredArrays arrays, umbrage::LayeredScene scene)
      : ball_(ball), arrays_(std::move(arrays)), scene_(std::move(scene)) {}
  void place_views(float scene_diagonal_m);
  umbrage::Result<void> create_depth(GpuContext&);
  umbrage::Result<void> create_set(const GpuContext&, const TextureTable&);
  umbrage::Result<void> create_color(GpuContext&);
  umbrage::Result<Layers> create_layers(GpuContext&, const LayerImagesDesc&, umbrage::LayeredPassSettings);

  MirrorBall ball_;
  LayeredArrays arrays_;
  umbrage::LayeredScene scene_;
  glm::mat4 clip_from_view_{1};
  std::array<glm::mat4, kFaces> view_from_world_;
  std::array<umbrage::LayeredView, kFaces> views_;
  std::optional<Layers> depth_, color_;
  std::array<Handle<VkImageView>, kFaces> depth_views_;
  Handle<VkImageView> all_depths_view_, color_view_;
  Handle<VkSampler> sampler_;
  DescriptorSet set_;
  DeviceBuffer data_;
};

}  // namespace app
