// The chapter's measurements (R4, R5): what is drawn, by whom, into how many maps of which size.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/layered_geometry.hpp"

namespace app {

class GpuContext;

/// One of the chapter's cases. Its scene has one or four instances, of which one is visible.
struct LayeredCase {
  const char* name;
  const char* figure;  ///< "19.3", …
  const char* summary;
  bool is_skinned = false;
  uint32_t instances = 1;
  bool rasterizes = false;
  umbrage::CasterSelection selection = umbrage::CasterSelection::all;
  bool cull_frustum = false;
  umbrage::CulledFaces culled_faces = umbrage::CulledFaces::none;
};
std::span<const LayeredCase> layered_cases();

constexpr std::array<umbrage::LayeredWriter, 8> kLayeredWriters{
    umbrage::LayeredWriter::traditional,   umbrage::LayeredWriter::geometry_invocations,
    umbrage::LayeredWriter::geometry_loop, umbrage::LayeredWriter::vertex_layer,
    umbrage::LayeredWriter::multiview,     umbrage::LayeredWriter::mesh,
    umbrage::LayeredWriter::atlas,         umbrage::LayeredWriter::compute};

/// False where the writer has no such form: culling per triangle and rasterizer discard are not everybody's.
bool runs_case(umbrage::LayeredWriter, const LayeredCase&);

/// A closed ring of 35,600 triangles with 64 bones: what is animated here in the dragon's stead.
LayeredArrays skinned_ring();
/// Poses its bones.
umbrage::Result<void> bend_ring(umbrage::LayeredScene&, uint32_t instances);
/// Copies of the only instance, above and below, where no view of views_of() sees them.
void add_hidden_instances(LayeredArrays&, uint32_t instances);
/// Views from a circle around the first instance, which each sees whole.
std::vector<umbrage::LayeredView> views_of(const LayeredArrays&, uint32_t count);

struct LayeredTimes {
  double gpu_ms = 0;         ///< The least: what else a machine does only ever adds.
  double gpu_ms_spread = 0;  ///< From the least to the median.
  double cpu_us = 0;         ///< prepare and record: the least.
  uint32_t repeats = 0;
  uint32_t splits = 0;
};
struct LayeredJob {
  umbrage::LayeredPassSettings settings;
  uint32_t side = 256;
  uint32_t repeats = 5;
  double enough_ms = 1e9;  ///< Of GPU time: once spent, three repeats do.
};
/// Draws views into the layers of a D16 array, clear included. One scene may be measured any number of times.
class LayeredBench {
 public:
  static umbrage::Result<LayeredBench> create(const std::string& device);
  LayeredBench(LayeredBench&&) noexcept;
  LayeredBench& operator=(LayeredBench&&) noexcept;
  ~LayeredBench();
  umbrage::DeviceDesc device() const;
  std::string device_name() const;
  std::string driver() const;
  std::string api() const;  ///< "1.3".
  umbrage::Result<LayeredTimes> measure(umbrage::LayeredScene&, const std::vector<umbrage::LayeredView>&, LayeredJob);

 private:
  explicit LayeredBench(std::unique_ptr<GpuContext>);
  std::unique_ptr<GpuContext> gpu_;
  uint64_t serial_ = 0;
};

/// False where the device lacks what the writer needs.
bool can_run(umbrage::LayeredWriter, const umbrage::Capabilities&);

}  // namespace app
