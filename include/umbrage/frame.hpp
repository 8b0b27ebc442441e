// What a host hands over for one frame.
#pragma once
#include <vulkan/vulkan_core.h>

#include <span>

#include "umbrage/settings.hpp"
#include "umbrage/types.hpp"

namespace umbrage {

enum class NormalEncoding : uint8_t {
  none,             ///< No normals: cluster normal cones hold every direction.
  octahedral_snorm, ///< World-space unit vector, octahedral map in the first two channels, -1…1.
  xyz_unorm,        ///< World-space, first three channels, stored as 0.5 n + 0.5.
  xyz_signed,       ///< World-space, first three channels of a signed format.
};

/// A camera whose depth buffer names the receivers: the picture's, the other eye's, a face of a reflection map. Projection is recovered from the matrices: either handedness,
/// reversed, infinite or OpenGL depth, flipped y, jitter, orthographic. Depth images: single-sampled, aspect depth.
struct CameraDesc {
  CameraId id{1};
  Mat4 view_from_world;                    ///< Rigid (rotation, translation, mirroring).
  Mat4 clip_from_view;                     ///< Clip depth 0…w (Vulkan) unless opengl_depth.
  bool opengl_depth = false;               ///< Clip depth is -w…w and the buffer holds 0.5 z/w + 0.5.
  uint32_t width = 0, height = 0;          ///< Pixels of the images' top-left area that hold this camera's picture.
  VkImageView depth = VK_NULL_HANDLE;
  VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
  VkImageView normal = VK_NULL_HANDLE;     ///< Geometric normals; VK_NULL_HANDLE with NormalEncoding::none.
  VkImageLayout normal_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  NormalEncoding normal_encoding = NormalEncoding::none;
  /// Points that this depth buffer does not hold will be looked up too (glass, fog, particles): every light gets a map,
  /// not only those that reach a cluster.
  bool other_receivers = false;
  /// Where they all lie, in world space; empty: anywhere. Only lights that reach a box get a map for them, which holds what casts
  /// on the boxes; a point elsewhere is lit, or shadowed at most by those. Of several cameras, the boxes of all. Read by begin_frame.
  std::span<const Aabb> other_receivers_ws;
};

struct FrameDesc {
  uint64_t serial = 0;                     ///< Larger than that of the frame before; starts at 1.
  uint64_t completed_serial = 0;           ///< The newest frame whose submission the device has finished; 0 = none.
  double time_s = 0;                       ///< The host's clock: how long casters have stood still (FrameSettings::static_after_ms).
  FrameSettings settings;
  std::span<const CameraDesc> cameras;     ///< 1…8, with different ids. The first divides the cascades.
  /// Stages that read the results after record_shadows.
  VkPipelineStageFlags2 consumer_stages = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
};

/// Store::hardware_sparse: what ShadowSystem::bind_pages works with.
struct PageBinding {
  VkQueue queue = VK_NULL_HANDLE;          ///< Of DeviceDesc::queue_family, with VK_QUEUE_SPARSE_BINDING_BIT; nobody else submits to it meanwhile.
  VkFence requests = VK_NULL_HANDLE;       ///< Of the submission that holds record_requests: waited for, not reset. VK_NULL_HANDLE: it has finished.
  VkSemaphore bound = VK_NULL_HANDLE;      ///< Binary, signalled once pages are bound; the submission of record_shadows waits for it. VK_NULL_HANDLE: the call waits.
};

/// What a shading shader needs. Valid from record_shadows of a frame until record_scene of the next.
struct ShaderInterface {
  VkDeviceAddress frame = 0;               ///< For umbrage_frame() in shaders/umbrage.glsl.
  VkDescriptorSet set = VK_NULL_HANDLE;    ///< Bind it at the set number that UMBRAGE_SET names; the page pool needs none.
};

}  // namespace umbrage
