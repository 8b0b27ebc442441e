// The machine's Vulkan devices and what each can do, without making one.
#pragma once
#include <vulkan/vulkan_core.h>

#include <string>
#include <vector>

#include "umbrage/device.hpp"

namespace app {

/// Whether a preset runs on a device.
struct PresetEntry {
  std::string needs;   ///< Beyond the required features; empty: nothing.
  std::string reason;  ///< Why not; empty: it runs.
};

struct DeviceEntry {
  std::string name, type;  ///< type: "discrete", "integrated", "virtual", "software", "other".
  std::string driver;      ///< Empty below Vulkan 1.3, where umbrage does not look further.
  std::string api;         ///< "1.3.280".
  bool is_supported = false;
  std::string reason;  ///< Why not, one line; empty when supported.
  std::vector<umbrage::RequirementCheck> checks;
  std::vector<PresetEntry> presets;  ///< In the order of umbrage::presets().
};

struct DeviceList {
  std::vector<DeviceEntry> devices;  ///< In the order of --device INDEX.
  bool has_validation_layer = false;
};

/// Errors: no Vulkan loader, no instance, no device; the message says what to install.
umbrage::Result<DeviceList> list_devices();

}  // namespace app
