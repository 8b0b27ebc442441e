// Everything that check_symbols.cmake must refuse.
#include <vulkan/vulkan.h>

#include <cstdlib>
#include <vector>

extern "C" void stray_function(VkInstance instance) {
  if (std::getenv("HOME") != nullptr) vkDestroyInstance(instance, nullptr);
}

template class std::vector<VkInstance>;
