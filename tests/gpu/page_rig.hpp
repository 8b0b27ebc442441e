// Maps, pages and work items as culling and store would make them, made by the test: what the writers of the page pool are fed.
#pragma once
#include <random>

#include "gpu.hpp"
#include "raster/page_fragments.hpp"
#include "raster/page_raster.hpp"
#include "reference/page_raster.hpp"
#include "scene_casters.hpp"

namespace umbrage::test {

/// A light's maps at one resolution. marked: share of its pages that are in the pool.
struct PageMap {
  uint32_t kind = shared::ViewsCube;
  uint32_t resolution = 128;
  std::vector<shared::ShadowView> views;
  double marked = 1;
  bool whole = false;  ///< Drawn whatever is looked up.
};
PageMap cube_map(const glm::vec3& origin, float near_m, uint32_t resolution, double marked = 1);
PageMap spot_map(const glm::vec3& origin, const glm::vec3& direction, float cone_rad, float near_m, uint32_t resolution,
                 double marked = 1);
PageMap ortho_map(const glm::vec3& direction, const glm::vec3& box_min, const glm::vec3& box_max, uint32_t resolution,
                  double marked = 1);

class PageRig {
 public:
  PageRig(Gpu&, const TestScene&, std::vector<PageMap>, uint32_t seed);

  /// Items of every caster in every map and view, shuffled; `by_face`: an item for each view.
  void list_items(uint32_t seed, bool by_face);
  /// From now on writers draw, of this share of the texels, those alone; in maps of whole pages that are not `whole`.
  void look_up(double share, uint32_t seed);
  const std::vector<uint32_t>& texel_bits() const { return texel_bits_; }
  /// Does the writer draw every texel of the map, whatever is looked up?
  bool draws_all(uint32_t map) const {
    return records_[map].receivers != shared::ReceiversInSight || maps_[map].resolution < shared::PageSide;
  }
  using Write = std::function<void(gpu::Recorder&, const raster::PageWriterInputs&)>;
  void clear();
  void run(const Write&, gpu::HazardLog* = nullptr);
  std::vector<uint32_t> pool() { return gpu_.download<uint32_t>(pool_, pool_.size() / sizeof(uint32_t)); }
  /// The pool after one writer has run on clear pages.
  std::vector<uint32_t> draw(const Write& write) { return clear(), run(write), pool(); }
  raster::PageWriterInputs inputs() const;
  uint32_t max_resolution() const;
  VkDeviceSize pool_bytes() const { return pool_.size(); }

  struct Page {
    uint32_t map, view;
    glm::uvec2 first;  // texel
    uint32_t side;
    uint32_t pool_texel;
  };
  const std::vector<Page>& pages() const { return pages_; }
  /// What the page should hold of the opaque casters.
  reference::DepthWindow reference(const Page&) const;

 private:
  void lay_out(std::mt19937&);
  Gpu& gpu_;
  TestScene test_scene_;
  std::vector<PageMap> maps_;
  std::vector<Page> pages_;
  std::vector<shared::MapRecord> records_;
  scene::GpuScene scene_;
  SceneCasters casters_;
  gpu::RetireQueue retired_;
  std::vector<shared::CasterItem> items_[2];  // opaque, masked
  uint32_t capacity_ = 0;
  shared::FrameRecord record_{};
  std::vector<uint32_t> texel_bits_;
  gpu::Buffer looked_up_, frame_, views_, map_buffer_, page_bits_, page_first_, pool_, item_buffer_, counts_;
};

}  // namespace umbrage::test
