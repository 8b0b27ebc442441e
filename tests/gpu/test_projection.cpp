// The generated cube_projection.glsl on the device against the same functions in C++.
#include <array>
#include <bit>

#include "gpu.hpp"
#include "umbrage/cube_projection.hpp"
#include "unit/cube_boxes.hpp"

namespace umbrage::test {
namespace {

class ProjectionOnDevice : public GpuTest {};

constexpr uint32_t kProject[] =
#include "shaders/cube_projection.comp.inc"
    ;
constexpr uint32_t kTiles = 64, kFaces = 6;

struct Push {
  Vec3 box_min;
  float bias_m;
  Vec3 box_max;
  uint32_t resolution;
};

/// What the shader writes for a box: std430.
struct Masks {
  uint32_t face_mask, pad;
  uint64_t rows[kFaces * kTiles];
};

/// A set with one storage buffer at a dynamic offset.
class MaskSet {
 public:
  MaskSet(const Gpu& gpu, const gpu::Buffer& buffer) : device_(gpu.desc().device) {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, 1,
                                               VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    layout.bindingCount = 1;
    layout.pBindings = &binding;
    check(vkCreateDescriptorSetLayout(device_, &layout, nullptr, &layout_), "vkCreateDescriptorSetLayout");
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, 1};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    check(vkCreateDescriptorPool(device_, &pool, nullptr, &pool_), "vkCreateDescriptorPool");
    VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocation.descriptorPool = pool_;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &layout_;
    check(vkAllocateDescriptorSets(device_, &allocation, &set_), "vkAllocateDescriptorSets");
    const VkDescriptorBufferInfo info{buffer.handle(), 0, sizeof(Masks)};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
    write.pBufferInfo = &info;
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
  }
  MaskSet(const MaskSet&) = delete;
  ~MaskSet() {
    vkDestroyDescriptorPool(device_, pool_, nullptr);
    vkDestroyDescriptorSetLayout(device_, layout_, nullptr);
  }
  const VkDescriptorSetLayout& layout() const { return layout_; }
  VkDescriptorSet set() const { return set_; }

 private:
  VkDevice device_;
  VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

TEST_F(ProjectionOnDevice, EqualsThatOfTheCpu) {
  const std::vector<Aabb> boxes = all_boxes(1000);
  constexpr VkDeviceSize kStride = (sizeof(Masks) + 255) / 256 * 256;
  constexpr uint32_t kResolution = 256;
  constexpr float kBias = 0.01f;
  const gpu::Buffer output = gpu().buffer(boxes.size() * kStride, gpu::MemoryKind::device, "masks");
  const MaskSet set(gpu(), output);
  const Program program(gpu(), kProject, {&set.layout(), 1});
  gpu().run([&](VkCommandBuffer commands) {
    const VkDescriptorSet handle = set.set();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline());
    for (uint32_t i = 0; i < boxes.size(); ++i) {
      const auto offset = static_cast<uint32_t>(i * kStride);
      const Push push{boxes[i].min, kBias, boxes[i].max, kResolution};
      vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.layout(), 0, 1, &handle, 1, &offset);
      vkCmdPushConstants(commands, program.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push, &push);
      vkCmdDispatch(commands, 1, 1, 1);
    }
  });
  const auto bytes = gpu().download<std::byte>(output, boxes.size() * kStride);
  uint32_t faces = 0, other_tiles = 0, tiles = 0;
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    const auto& masks = *reinterpret_cast<const Masks*>(&bytes[i * kStride]);
    const Aabb grown = grow_receiver_box(boxes[i], kResolution, 1.5f, kBias);
    ASSERT_EQ(masks.face_mask, cube_face_mask(grown)) << "box " << i;
    for (uint32_t face = 0; face < kFaces; ++face) {
      std::array<uint64_t, kTiles> rows;
      cube_tile_mask(grown, static_cast<CubeFace>(face), rows);
      faces += masks.face_mask >> face & 1;
      for (uint32_t row = 0; row < kTiles; ++row) {
        tiles += static_cast<uint32_t>(std::popcount(rows[row]));
        other_tiles += static_cast<uint32_t>(std::popcount(rows[row] ^ masks.rows[face * kTiles + row]));
      }
    }
  }
  EXPECT_GT(faces, boxes.size());
  EXPECT_EQ(other_tiles, 0u) << "of " << tiles << " tiles of " << boxes.size() << " boxes";
}

}  // namespace
}  // namespace umbrage::test
