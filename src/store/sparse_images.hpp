// Hardware sparse (O13, O15, O18): maps lie in sparse images, made beforehand in resolution classes; only pages that lookups
// touch have memory. Which, the device says; the host binds them between requests and raster.
#pragma once
#include "store/map_images.hpp"
#include "store/page_residency.hpp"

namespace umbrage::store {

/// How texels are written, and what a page of them is.
struct SparseForm {
  bool is_attachment = false;  ///< D16, written by the hardware's depth test; else 32-bit words, written by shaders.
  glm::uvec2 page{0};          ///< Texels.
  bool is_sparse = true;  ///< false: ordinary images, for tests of the rest where a driver's sparse ones do not work.
  VkFormat format() const { return is_attachment ? VK_FORMAT_D16_UNORM : VK_FORMAT_R32_UINT; }
  uint64_t texel_bytes() const { return is_attachment ? 2 : 4; }
  VkImageUsageFlags usage() const;
};
constexpr uint64_t kSparsePageBytes = 64 << 10;

/// What the settings ask for, if the device can. Errors: unsupported, with the reason.
Result<SparseForm> choose_sparse_form(const gpu::Device&, SparseTexels asked);

/// Maps of every light that the ordinary images have room for.
constexpr uint64_t kOrdinaryMaps = 4;

struct SparseLayout {
  ImageLayout images;  ///< Classes of whole pages, and last an ordinary one for maps below 64 texels.
  uint32_t pages = 0;  ///< That may have memory at once.
  uint64_t ordinary_texels = 0;
};
/// demand.texels: of memory. address_texels: of all sparse images together; image_texels: of one.
SparseLayout lay_out_sparse(const ImageDemand& demand, const SparseForm&, uint64_t address_texels,
                            uint64_t image_texels);

class SparseImages {
 public:
  static Result<SparseImages> create(const gpu::Device&, const gpu::PipelineFactory&, const SparseForm&);
  SparseImages() = default;
  SparseImages(SparseImages&&) noexcept;
  SparseImages& operator=(SparseImages&&) noexcept;
  ~SparseImages();

  Result<void> reserve(const gpu::Device&, gpu::Memory&, const SparseLayout&, gpu::RetireQueue&, uint64_t serial);
  /// The pages that the frame needs → `target` (SparseRequests, then SparsePage), for the host.
  void record_requests(gpu::Recorder&, const maps::Maps&, const gpu::Buffer& frame, const gpu::Buffer& counters,
                       const gpu::Buffer& target) const;
  VkDeviceSize request_bytes() const {
    return sizeof(shared::SparseRequests) + layout_.pages * sizeof(shared::SparsePage);
  }

  struct Bound {
    uint64_t bytes_read = 0;
    uint32_t bound = 0, unbound = 0;
  };
  /// Binds what a finished record_requests wrote to `requests`, and unbinds the rest. `done` is signalled then; without it the call
  /// waits. On errors nothing is known to have changed.
  Result<Bound> bind(VkQueue, const gpu::Buffer& requests, VkSemaphore done);

  const SparseForm& form() const { return form_; }
  const SparseLayout& layout() const { return layout_; }
  const MapImages& images() const { return images_; }
  const PageResidency& residency() const { return residency_; }
  VkDeviceSize memory_bytes() const {
    return layout_.pages * kSparsePageBytes + layout_.ordinary_texels * form_.texel_bytes();
  }

 private:
  Result<void> reserve_pages(gpu::Memory&, uint32_t pages);
  Result<void> reserve_metadata(gpu::Memory&);
  VkSparseImageMemoryBind image_bind(const BoundPage&, bool has_memory) const;
  Result<void> submit(VkQueue, VkSemaphore done);

  const gpu::Device* device_ = nullptr;
  SparseForm form_;
  SparseLayout layout_;
  MapImages images_;
  gpu::Pipeline list_;
  PageResidency residency_;
  std::vector<gpu::Allocation> memory_;                                 // kSlotsPerBlock pages each
  std::vector<gpu::Allocation> metadata_;                               // of images whose driver keeps some
  std::vector<std::pair<VkImage, VkSparseMemoryBind>> metadata_binds_;  // not yet submitted
  std::vector<VkSparseImageMemoryBind> binds_;                          // image by image
  VkFence fence_ = VK_NULL_HANDLE;
};

}  // namespace umbrage::store
