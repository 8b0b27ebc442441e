// What check_symbols.cmake must refuse.
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdlib>

extern "C" void stray_function(VkInstance instance) {
  if (std::getenv("HOME") != nullptr) vkDestroyInstance(instance, nullptr);
}

template const int& std::min<int>(const int&, const int&);
