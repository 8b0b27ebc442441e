// Many views of a scene in one pass (after Rákos 2012): N matrices, a set of batches, the layers of an array image. Needs no
// ShadowSystem. docs/layered-rendering.md says which writer is fast where; every one draws the same layers.
#pragma once
#include <vulkan/vulkan_core.h>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "umbrage/layered_scene.hpp"

namespace umbrage {

enum class LayeredWriter : uint8_t {
  traditional,  ///< A render pass per view. Needs nothing.
  geometry_invocations,  ///< A geometry shader invocation per view, up to the device's limit, each looping beyond it. Needs geometry_shader.
  geometry_loop,  ///< One invocation emits every view: what OpenGL 3 could do. Needs geometry_shader.
  vertex_layer,   ///< An instance per view, the vertex shader writes the layer. Needs vertex_layer.
  multiview,      ///< The driver repeats the draw per layer: one view a layer, each the whole of it. Needs multiview.
  mesh,           ///< A task shader per batch, a mesh shader per view that sees it. Needs mesh_shader.
  atlas,          ///< An instance per view, views side by side in a layer. Needs nothing.
  compute,        ///< Depth by atomics in a buffer, copied into the image. Depth only, always clears; the depth image
                  ///< needs TRANSFER_DST usage.
};
/// "traditional", …, as the program and settings files name them.
std::string_view name_of(LayeredWriter);

enum class LayeredVertices : uint8_t {
  simple,        ///< One model matrix: the scene has a single, rigid instance (listing 19.6).
  instanced,     ///< A model matrix an instance (listing 19.8).
  skinned,       ///< Up to four 3×4 bones a vertex, then the model matrix (listing 19.7, corrected: E12).
  skinned_mat3,  ///< Listing 19.7 as printed: bones without translation, no model matrix.
};
/// Which batches are drawn, decided on the device from their boxes. Skinned instances are always drawn.
enum class CasterSelection : uint8_t {
  all,
  any_view,   ///< R3: left out when no view of a render pass sees it.
  each_view,  ///< And drawn only into the views that see it (multiview: like any_view).
};
/// Dropped triangles. A mesh's front is counter-clockwise from outside. Geometry, mesh and compute writers test in the shader
/// (E14), the others leave it to the fixed function.
enum class CulledFaces : uint8_t { none, back, front };
enum class DepthOrder : uint8_t {
  smaller_is_nearer,  ///< Cleared to 1.
  larger_is_nearer,   ///< Cleared to 0: reversed depth.
};

/// The host's images with the views that rendering needs. Layers of one size.
struct LayeredTargetDesc {
  VkImage depth = VK_NULL_HANDLE;
  VkFormat depth_format = VK_FORMAT_D32_SFLOAT;  ///< D16_UNORM or D32_SFLOAT.
  VkImage color = VK_NULL_HANDLE;                ///< Colour passes: as many layers.
  VkFormat color_format = VK_FORMAT_UNDEFINED;
  uint32_t width = 0, height = 0, layers = 0;
};
class LayeredTarget {
 public:
  /// The scene outlives the target.
  static Result<LayeredTarget> create(const LayeredScene&, const LayeredTargetDesc&);
  LayeredTarget(LayeredTarget&&) noexcept;
  LayeredTarget& operator=(LayeredTarget&&) noexcept;
  ~LayeredTarget();
  struct State;

 private:
  friend class LayeredPass;
  explicit LayeredTarget(std::unique_ptr<State>);
  std::unique_ptr<State> state_;
};

struct LayeredView {
  Mat4 clip_from_world;  ///< Any invertible-on-screen matrix: clip depth 0…w, what has w <= 0 is not seen.
  uint32_t layer = 0;
  VkRect2D area{{0, 0}, {0, 0}};  ///< Its texels of the layer; extent 0: the whole layer.
};

struct LayeredPassSettings {
  LayeredWriter writer = LayeredWriter::traditional;
  uint32_t views = 1;  ///< At most, 1…256; multiview: exactly.
  LayeredVertices vertices = LayeredVertices::instanced;
  CasterSelection selection = CasterSelection::any_view;
  bool cull_frustum = false;  ///< Listing 19.9 per triangle: geometry and mesh writers; the others always clip.
  CulledFaces culled_faces = CulledFaces::none;
  DepthOrder depth_order = DepthOrder::smaller_is_nearer;
  VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
  bool areas = false;               ///< Views may be parts of a layer (atlas: always).
  bool rasterizer_discard = false;  ///< For measurements of the geometry stages alone; not with compute.
  /// Colour: SPIR-V of a fragment shader with inputs 0 vec3 position_ws, 1 vec3 normal_ws (any length), 2 vec2 uv, 3 flat uint
  /// host_index, 4 flat uint view (index into prepare's views); set 1 is color_set_layout's, push constant 0 is host_data.
  std::span<const uint32_t> color_fragment;
  VkFormat color_format = VK_FORMAT_UNDEFINED;
  VkDescriptorSetLayout color_set_layout = VK_NULL_HANDLE;
};

class LayeredPass {
 public:
  /// Compiles its pipelines. The scene outlives the pass. Errors: unsupported (names writer, feature and device).
  static Result<LayeredPass> create(LayeredScene&, const LayeredPassSettings&);
  LayeredPass(LayeredPass&&) noexcept;
  LayeredPass& operator=(LayeredPass&&) noexcept;
  ~LayeredPass();
  struct Inputs {
    const LayeredTarget& target;
    std::span<const LayeredView> views;
    bool clear = true;  ///< False: drawn over what is there.
    VkClearColorValue clear_color{};
    VkDescriptorSet color_set = VK_NULL_HANDLE;
    VkDeviceAddress host_data = 0;
  };
  /// Once a frame, after the scene's begin_frame; splits the views as the device's limits demand.
  Result<void> prepare(const Inputs&);
  /// After the scene's record, outside of rendering. The images are in DEPTH_ATTACHMENT_OPTIMAL and COLOR_ATTACHMENT_OPTIMAL
  /// before and after, earlier uses waited for; results are written by the attachment stages. Layers without views stay.
  void record(VkCommandBuffer);
  uint32_t splits() const;  ///< Render passes (compute: rounds) of the last prepare.

 private:
  struct State;
  explicit LayeredPass(std::unique_ptr<State>);
  std::unique_ptr<State> state_;
};

/// What drawing costs, in any unit: of a group, casters × (caster + views × caster_in_view) + pass.
struct GroupingCosts {
  double caster = 1;            ///< Vertices: once a pass.
  double caster_in_view = 0.5;  ///< Triangles: once a view, seen or not (CasterSelection::any_view).
  double pass = 1;              ///< Of another pass.
  uint32_t most_views = 256;    ///< Of a group.
};
/// Views that are worth a pass together, because they see the same casters (world boxes); every view is in one group. Passes
/// with CasterSelection::each_view need none of this. Time grows with views³ × casters / 64.
std::vector<std::vector<uint32_t>> group_overlapping_views(std::span<const LayeredView> views,
                                                           std::span<const Aabb> casters, const GroupingCosts& = {});

}  // namespace umbrage
