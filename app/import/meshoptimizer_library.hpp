// meshoptimizer, loaded when it is first needed: the program starts without it.
#pragma once
#include <cstddef>

namespace app {

/// What is used of it, each as in meshoptimizer.h.
struct MeshoptimizerLibrary {
  size_t (*generate_vertex_remap)(unsigned* remap, const unsigned* indices, size_t index_count, const void* vertices,
                                  size_t vertex_count, size_t vertex_size);
  size_t (*simplify)(unsigned* destination, const unsigned* indices, size_t index_count, const float* positions,
                     size_t vertex_count, size_t stride, size_t target_index_count, float target_error,
                     unsigned options, float* error);
  float (*simplify_scale)(const float* positions, size_t vertex_count, size_t stride);
};

/// Looked for in lib/ beside the program, then where the system has its libraries. Null when it is in neither, which is said once on
/// stderr.
const MeshoptimizerLibrary* meshoptimizer_library();

}  // namespace app
