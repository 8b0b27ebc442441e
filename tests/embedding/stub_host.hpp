// A host reduced to what the library asks of one: boxes drawn to depth and normals under any convention, and a compute
// shader that asks umbrage.glsl for the visibility of every pixel and light.
#pragma once
#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <umbrage/umbrage.hpp>
#include <vector>
#include <vulkan/vulkan.hpp>

namespace embedding {

constexpr uint32_t picture_width = 192, picture_height = 128;

struct Box {
  glm::vec3 center_ws, half_extent;
};

/// Boxes and lights; the lights' host_index counts from 0. `offset` moves everything, `mirrored` makes the library's
/// instances from a mirrored mesh: neither changes what is seen by a camera that moves along.
struct Scene {
  std::vector<Box> boxes;
  std::vector<umbrage::LightDesc> lights;
  bool mirrored = false;

  static Scene room(glm::vec3 offset = {});
  /// Throws what the library refuses, unless `again` is there and says that the same edit is to be tried once more.
  void add_to(umbrage::ShadowSystem&, const std::function<bool(const umbrage::Error&)>& again = {}) const;
};

/// How a host may set up its camera and hand it over. The defaults are reversed, infinite depth, right-handed.
struct Convention {
  const char* name = "reversed infinite";
  glm::mat4 view_from_world{1}, clip_from_view{1};
  bool opengl_depth = false;
  bool near_is_one = true;  ///< Reversed: cleared to 0, greater is nearer.
  bool flipped = false;     ///< The picture is upside down against the others'.
  umbrage::NormalEncoding encoding = umbrage::NormalEncoding::xyz_signed;

  /// The defaults, from the end of Scene::room().
  static Convention in_room();
};

/// What the shader saw; rows always from the top.
struct Visibility {
  std::vector<float> of;            ///< By pixel, then light. -1: not in the pixel's list.
  std::vector<float> cone_cosines;  ///< Of the normal cones of the pixels that have lights; -2: the cone is wrong.
};

class StubHost {
 public:
  StubHost(const umbrage::DeviceDesc&, VkQueue, VkDescriptorSetLayout umbrage_layout);
  /// One frame from begin_frame to the device being idle. `again` as in Scene::add_to, for begin_frame.
  Visibility render(umbrage::ShadowSystem&, const Scene&, const Convention&,
                    const std::function<bool(const umbrage::Error&)>& again = {});
  // The steps of render(), for tests that look between them: describe, begin_frame, begin_commands, record_scene, draw,
  // record_shadows, read, submit_and_wait.
  umbrage::FrameDesc describe(const Convention&, umbrage::CameraDesc&);
  vk::CommandBuffer begin_commands();
  void draw(vk::CommandBuffer, const Scene&, const Convention&);
  void read(vk::CommandBuffer, const umbrage::ShadowSystem&, const Scene&, const Convention&);
  void submit_and_wait(vk::CommandBuffer);

 private:
  struct Image {
    vk::UniqueDeviceMemory memory;
    vk::UniqueImage image;
    vk::UniqueImageView view;
  };
  vk::UniqueDeviceMemory allocate(const vk::MemoryRequirements&, vk::MemoryPropertyFlags) const;
  Image make_image(vk::Format, vk::ImageUsageFlags, vk::ImageAspectFlags) const;
  void make_visibility_buffer(uint32_t lights);
  void make_set();
  vk::UniquePipeline make_draw_pipeline(const Convention&) const;
  void make_read_pipeline(vk::DescriptorSetLayout umbrage_layout);
  void to_attachments(vk::CommandBuffer) const;
  void to_sampled(vk::CommandBuffer) const;

  vk::PhysicalDevice physical_device_;
  vk::Device device_;
  vk::Queue queue_;
  uint64_t serial_ = 0;
  Image depth_, plain_normal_, normal_;
  vk::UniqueDeviceMemory visibility_memory_;
  vk::UniqueBuffer visibility_;
  float* visibility_values_ = nullptr;
  vk::UniqueDescriptorSetLayout set_layout_;
  vk::UniqueDescriptorPool descriptor_pool_;
  vk::DescriptorSet set_;
  vk::UniquePipelineLayout draw_layout_, read_layout_;
  vk::UniquePipeline draw_, read_;
  vk::UniqueCommandPool command_pool_;
};

}  // namespace embedding
