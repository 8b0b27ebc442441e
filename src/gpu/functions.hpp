// The library's own Vulkan function table (embedding promise 1): nothing here is linked against the loader.
#pragma once
#include <vulkan/vulkan_core.h>

namespace umbrage::gpu {

#define UMB_INSTANCE_FUNCTIONS(X)                                                                              \
  X(vkGetDeviceProcAddr)                                                                                       \
  X(vkDestroyInstance) X(vkEnumeratePhysicalDevices) X(vkGetPhysicalDeviceProperties)                          \
      X(vkGetPhysicalDeviceProperties2) X(vkGetPhysicalDeviceFeatures2) X(vkGetPhysicalDeviceMemoryProperties) \
          X(vkGetPhysicalDeviceQueueFamilyProperties) X(vkGetPhysicalDeviceSparseImageFormatProperties)        \
              X(vkGetPhysicalDeviceImageFormatProperties) X(vkEnumerateDeviceExtensionProperties) X(vkCreateDevice)

#define UMB_DEVICE_FUNCTIONS(X)                                                                                        \
  X(vkDestroyDevice)                                                                                                   \
  X(vkGetDeviceQueue) X(vkDeviceWaitIdle) X(vkAllocateMemory) X(vkFreeMemory) X(vkMapMemory) X(vkCreateBuffer)         \
      X(vkDestroyBuffer) X(vkGetBufferMemoryRequirements) X(vkBindBufferMemory) X(vkGetBufferDeviceAddress)            \
          X(vkCreateImage) X(vkDestroyImage) X(vkGetImageMemoryRequirements) X(vkBindImageMemory) X(vkCreateImageView) \
              X(vkDestroyImageView) X(vkCreateSampler) X(vkDestroySampler) X(vkCreateShaderModule)                     \
                  X(vkDestroyShaderModule) X(vkCreatePipelineLayout) X(vkDestroyPipelineLayout)                        \
                      X(vkCreateDescriptorSetLayout) X(vkDestroyDescriptorSetLayout) X(vkCreateDescriptorPool)         \
                          X(vkDestroyDescriptorPool) X(vkAllocateDescriptorSets) X(vkUpdateDescriptorSets)             \
                              X(vkCreatePipelineCache) X(vkDestroyPipelineCache) X(vkGetPipelineCacheData)             \
                                  X(vkCreateComputePipelines) X(vkCreateGraphicsPipelines) X(vkDestroyPipeline)        \
                                      X(vkCreateQueryPool) X(vkDestroyQueryPool) X(vkGetQueryPoolResults)              \
                                          X(vkCmdResetQueryPool) X(vkCmdWriteTimestamp2) X(vkCmdPipelineBarrier2)      \
                                              X(vkCmdBindPipeline) X(vkCmdBindDescriptorSets) X(vkCmdPushConstants)    \
                                                  X(vkCmdDispatch) X(vkCmdDispatchIndirect) X(vkCmdCopyBuffer) X(      \
                                                      vkCmdFillBuffer) X(vkCmdBeginRendering) X(vkCmdEndRendering)     \
                                                      X(vkCmdSetViewport) X(vkCmdSetScissor) X(vkCmdBindIndexBuffer)   \
                                                          X(vkCmdBindVertexBuffers) X(vkCmdDrawIndexedIndirectCount)   \
                                                              X(vkCmdCopyBufferToImage) X(vkCmdSetCullMode)            \
                                                                  X(vkCmdSetFrontFace) X(vkCmdDrawIndirectCount)       \
                                                                      X(vkGetImageSparseMemoryRequirements)            \
                                                                          X(vkQueueBindSparse) X(vkCreateFence)        \
                                                                              X(vkDestroyFence) X(vkWaitForFences)     \
                                                                                  X(vkResetFences)

/// Loaded only where VK_EXT_mesh_shader is enabled.
#define UMB_MESH_FUNCTIONS(X) X(vkCmdDrawMeshTasksIndirectEXT)

/// Loaded only where VK_EXT_debug_utils is enabled.
#define UMB_DEBUG_FUNCTIONS(X) \
  X(vkSetDebugUtilsObjectNameEXT) X(vkCmdBeginDebugUtilsLabelEXT) X(vkCmdEndDebugUtilsLabelEXT)

struct Functions {
#define UMB_MEMBER(name) PFN_##name name = nullptr;
  UMB_INSTANCE_FUNCTIONS(UMB_MEMBER)
  UMB_DEVICE_FUNCTIONS(UMB_MEMBER)
  UMB_MESH_FUNCTIONS(UMB_MEMBER)
  UMB_DEBUG_FUNCTIONS(UMB_MEMBER)
#undef UMB_MEMBER

  /// Both return the name of the first function that is missing, or nullptr.
  const char* load_instance(VkInstance, PFN_vkGetInstanceProcAddr);
  const char* load_device(VkDevice, bool debug_utils, bool mesh_shader);
};

}  // namespace umbrage::gpu
