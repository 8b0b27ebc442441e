// One frame on the device: the stages and what passes between them.
#pragma once
#include <array>
#include <vector>

#include "cascades/cascades.hpp"
#include "clusters/clusters.hpp"
#include "culling/caster_culling.hpp"
#include "culling/map_culling.hpp"
#include "gpu/recorder.hpp"
#include "raster/layer_writer.hpp"
#include "raster/page_fragments.hpp"
#include "raster/page_raster.hpp"
#include "raster/writers.hpp"
#include "scene/gpu_scene.hpp"
#include "store/fixed_cubes.hpp"
#include "store/page_pool.hpp"
#include "store/sparse_images.hpp"

namespace umbrage {

/// What begin_frame decided for the frame being recorded.
struct FramePlan {
  FrameSettings settings;
  Store store = Store::page_pool;
  std::array<clusters::FrameCamera, shared::MaxCameras> cameras;
  std::array<CameraId, shared::MaxCameras> camera_ids;
  uint32_t camera_count = 0;
  bool cascades = false;
  uint32_t caster_rounds = 1;
  VkPipelineStageFlags2 consumer_stages = 0;
  uint64_t serial = 0;

  std::span<const clusters::FrameCamera> seen() const { return {cameras.data(), camera_count}; }
};

/// The device's record of a frame, as it lies in one buffer.
struct FrameBlock {
  shared::FrameRecord record;  // of the first camera
  shared::TreeShape caster_shape, light_shape;
  std::array<shared::MapImage, shared::MaxMapImages> images;
  std::array<shared::CameraRecord, shared::MaxCameras> cameras;
  std::array<shared::FrameRecord, shared::MaxCameras - 1> other_records;  // of the other cameras
};

struct Frame {
  static Result<std::unique_ptr<Frame>> create(const gpu::Device&, gpu::Memory&, const gpu::PipelineFactory&,
                                               const StaticSettings&);

  /// 0…1: needs no depth buffer.
  void record_scene(gpu::Recorder&, const FramePlan&, gpu::Uploader&, gpu::RetireQueue&);
  /// 3…8: after the host's depth. Store::hardware_sparse: which pages are needed, for the host, goes to `requests`.
  void record_requests(gpu::Recorder&, const FramePlan&, const gpu::Buffer& requests);
  /// 9…11
  void record_shadows(gpu::Recorder&, const FramePlan&, gpu::RetireQueue&);
  /// Counters and light states for the host, into `target` (FrameReport, then a word a light slot).
  void record_statistics(gpu::Recorder&, const gpu::Buffer& target);

  /// The images that maps lie in: none, those of the physical pool, or sparse ones.
  const store::MapImages& map_images(Store kind) const {
    return kind == Store::hardware_sparse ? sparse.images() : images;
  }
  /// What the casters of the page pool are culled and drawn with.
  culling::MapCulling::Inputs cull_inputs(const FramePlan&) const;
  /// Only texels that lookups of samples read (ReceiverBoxes::samples)?
  static bool draws_samples_only(const FramePlan&);
  raster::PageWriterInputs page_inputs(const FramePlan&) const;

  VkDeviceAddress caster_shape() const { return block.address() + offsetof(FrameBlock, caster_shape); }
  VkDeviceAddress camera_record(uint32_t camera) const {
    return block.address() + offsetof(FrameBlock, cameras) + camera * sizeof(shared::CameraRecord);
  }
  VkDeviceAddress frame_record(uint32_t camera) const {
    return camera == 0
               ? block.address()
               : block.address() + offsetof(FrameBlock, other_records) + (camera - 1) * sizeof(shared::FrameRecord);
  }
  VkDeviceAddress image_table() const { return block.address() + offsetof(FrameBlock, images); }
  VkDeviceAddress light_shape() const { return block.address() + offsetof(FrameBlock, light_shape); }

  scene::ScenePipelines scene_pipelines;
  scene::GpuScene scene;
  clusters::Clusters clusters;
  maps::Views views;
  maps::OtherReceivers others;
  // Virtual shadow maps
  maps::Maps maps;
  culling::MapCulling map_culling;
  // Store::page_pool
  store::PagePool pool;
  raster::PageRaster page_raster;
  raster::PageFragments page_fragments;
  // Store::physical_pool
  store::MapImages images;
  // Store::hardware_sparse
  store::SparseImages sparse;
  raster::LayerWriter layer_writer;  // of both
  // Store::fixed_cubes
  store::FixedCubes store;
  culling::CasterCulling culling;
  raster::Writers writers;
  // Of directional lights, beside any store
  cascades::Cascades cascades;
  gpu::Buffer block, counters;
  uint32_t max_draws = 0;

 private:
  void record_virtual_maps(gpu::Recorder&, const FramePlan&);
  void publish(gpu::Recorder&, const FramePlan&);
  void record_pages(gpu::Recorder&, const FramePlan&, const culling::MapCulling::Inputs&);
  void record_layers(gpu::Recorder&, const FramePlan&, const culling::MapCulling::Inputs&);
  maps::Maps::Backing backing(Store) const;
  Result<void> create_sparse(const gpu::Device&, const gpu::PipelineFactory&, SparseTexels);
  void record_fixed_cubes(gpu::Recorder&, const FramePlan&);
  std::vector<const gpu::Buffer*> published_;  // kept, so that recording allocates nothing
  std::vector<const gpu::Image*> published_images_;
  Frame(const gpu::Device& device, gpu::Memory& memory, const StaticSettings& settings)
      : scene(device, memory, settings) {}
};

}  // namespace umbrage
