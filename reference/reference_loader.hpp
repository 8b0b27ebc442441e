// Finds the ray tracer's module and makes a tracer of a posed scene. Programs link this; Embree comes in only when it
// is called.
#pragma once
#include <filesystem>
#include <memory>

#include "reference/ray_tracer.hpp"
#include "umbrage/result.hpp"

namespace reference {

/// A tracer of the scene at the pose's time. scene outlives it; pose is read during the call only. module: the file
/// to load; empty = libumbrage_reference.so beside the running program, in lib/ there, or where installation puts it.
/// Errors: unsupported, in the words of whatever failed: module or what it needs not found, module of another build,
/// memory short, scene with indices that lead nowhere.
umbrage::Result<std::unique_ptr<RayTracer>> load_ray_tracer(const app::Scene& scene, const app::Pose& pose,
                                                            const std::filesystem::path& module = {});

}  // namespace reference
