// The validation layers under the leak checker.
#pragma once
#include <dlfcn.h>

namespace umbrage::test {

/// Loaded ones stay so, and the leak checker knows their own leaks by name (lsan.supp).
inline void keep_validation_layers() {
  dlopen("libVkLayer_khronos_validation.so", RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
}

}  // namespace umbrage::test
