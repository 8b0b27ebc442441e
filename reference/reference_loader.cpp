#include "reference/reference_loader.hpp"

#include <dlfcn.h>

#include <string>
#include <system_error>

namespace reference {
namespace {

using umbrage::Error;
using umbrage::ErrorCode;
using umbrage::Result;

constexpr const char* module_name = "libumbrage_reference.so";

Result<std::filesystem::path> find_module() {
  std::error_code failure;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failure);
  if (failure) return Error{ErrorCode::unsupported, "ray tracer: /proc/self/exe cannot be read: mount /proc"};
  const std::filesystem::path folder = program.parent_path();
  std::string tried;
  for (const char* place : {".", "lib", UMBRAGE_REFERENCE_INSTALLED}) {
    const std::filesystem::path candidate = (folder / place / module_name).lexically_normal();
    if (std::filesystem::exists(candidate, failure)) return candidate;
    tried += (tried.empty() ? "" : ", ") + candidate.parent_path().string();
  }
  return Error{ErrorCode::unsupported, std::string("ray tracer: ") + module_name + " is in none of " + tried +
                                           ": build umbrage_reference, or carry lib/ along with the program"};
}

struct Module {
  CreateRayTracer create = nullptr;
};

Result<Module> load_module(const std::filesystem::path& module) {
  // Never unloaded: Embree's and TBB's threads may outlive the last tracer.
  void* library = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* symbol = library ? dlsym(library, create_ray_tracer_symbol) : nullptr;
  if (!symbol) {
    const char* reason = dlerror();
    return Error{ErrorCode::unsupported, std::string("ray tracer: ") +
                                             (reason ? reason : "the module is not one of umbrage's") +
                                             ": install libembree, or carry lib/ along with the program"};
  }
  return Module{reinterpret_cast<CreateRayTracer>(symbol)};
}

std::vector<DeformedPrimitive> deform(const app::Scene& scene, const app::Pose& pose) {
  std::vector<DeformedPrimitive> result;
  for (uint32_t i = 0; i < pose.instances.size(); ++i) {
    const app::PosedInstance& instance = pose.instances[i];
    if ((instance.skin < 0 && instance.weights.empty()) || instance.mesh >= scene.meshes.size()) continue;
    const std::vector<app::Primitive>& primitives = scene.meshes[instance.mesh].primitives;
    for (uint32_t p = 0; p < primitives.size(); ++p) {
      result.push_back({i, p, app::deformed_positions(primitives[p], instance, pose)});
    }
  }
  return result;
}

}  // namespace

Result<std::unique_ptr<RayTracer>> load_ray_tracer(const app::Scene& scene, const app::Pose& pose,
                                                   const std::filesystem::path& module) {
  std::filesystem::path path = module;
  if (path.empty()) {
    auto found = find_module();
    if (!found) return found.error();
    path = found.value();
  }
  auto loaded = load_module(path);
  if (!loaded) return loaded.error();
  const std::vector<DeformedPrimitive> deformed = deform(scene, pose);
  char message[512] = "";
  std::unique_ptr<RayTracer> tracer(
      loaded->create(tracer_interface_version, {&scene, &pose, deformed}, message, sizeof message));
  if (!tracer) return Error{ErrorCode::unsupported, message};
  return tracer;
}

}  // namespace reference
