// Which form a device can have, and how its address space is divided into classes.
#include <algorithm>
#include <bit>
#include <vector>

#include "store/sparse_images.hpp"

namespace umbrage::store {

namespace {
/// Maps below 64 texels are ordinary images, as in the paper; how coarse depends on the memory.
constexpr uint32_t kOrdinarySide = shared::LeastSparseSide / 2;

Error refused(const gpu::Device& device, std::string why) {
  return {ErrorCode::unsupported, "store=hardware_sparse on " + device.name() + ": " + std::move(why)};
}

/// Fills in the page; says why not.
Result<SparseForm> check_form(const gpu::Device& device, bool is_attachment) {
  SparseForm form{.is_attachment = is_attachment};
  const char* what = is_attachment ? "D16_UNORM depth attachments" : "R32_UINT storage images";
  if (is_attachment && device.driver_id() == VK_DRIVER_ID_MESA_LLVMPIPE)
    return refused(device,
                   "sparse depth attachments are broken in this driver (it draws rows and reads tiles); "
                   "sparse_texels=words works");
  if (is_attachment && !device.capabilities().vertex_layer)
    return refused(device, "sparse_texels=depth16 needs shaderOutputLayer (Capabilities::vertex_layer)");
  const auto page = device.sparse_page(form.format(), form.usage());
  if (!page) return refused(device, std::string("it has no sparse ") + what);
  form.page = {page->width, page->height};
  const bool fits = std::has_single_bit(page->width) && std::has_single_bit(page->height) &&
                    page->width >= page->height && page->height >= shared::LeastSparseSide &&
                    page->width * page->height * form.texel_bytes() == kSparsePageBytes;
  if (!fits)
    return refused(device, std::string("pages of its ") + what + " are " + std::to_string(page->width) + "x" +
                               std::to_string(page->height) + ", not 64 KiB of wide rectangles");
  return form;
}
}  // namespace

VkImageUsageFlags SparseForm::usage() const {
  return VK_IMAGE_USAGE_SAMPLED_BIT |
         (is_attachment ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_STORAGE_BIT);
}

Result<SparseForm> choose_sparse_form(const gpu::Device& device, SparseTexels asked) {
  if (!device.capabilities().sparse_residency)
    return refused(device,
                   "sparseBinding, sparseResidencyImage2D and indexing of storage images "
                   "(Capabilities::sparse_residency) are missing or not enabled");
  if (!device.binds_sparse())
    return refused(device, "the queue family of DeviceDesc::queue_family cannot bind sparse memory");
  if (asked != SparseTexels::automatic) return check_form(device, asked == SparseTexels::depth16);
  auto attachment = check_form(device, true);
  return attachment ? attachment : check_form(device, false);
}

SparseLayout lay_out_sparse(const ImageDemand& demand, const SparseForm& form, uint64_t address_texels,
                            uint64_t image_texels) {
  SparseLayout out;
  ImageLayout& layout = out.images;
  const uint64_t least = coarsest_layers(demand.views, kOrdinaryMaps);
  add_images(layout, coarsest_side(least, demand.texels, kOrdinarySide), least, demand.most_layers);
  number_layers(layout);
  const uint32_t ordinary_views = layout.most_views;
  out.ordinary_texels = layout.texels;
  const uint32_t finest =
      std::max(std::min(std::bit_ceil(demand.finest), std::bit_floor(demand.most_side)), form.page.x);
  // A light's maps may be two of a class: sizes are multiples of a page, classes powers of two.
  const uint64_t wanted = (2 * uint64_t(demand.views) + 5) / 6 * 6;
  for (uint32_t side = form.page.x; side <= finest && layout.images.size() < shared::MaxMapImages; side *= 2) {
    const uint64_t layer = uint64_t(side) * side, used = layout.texels - out.ordinary_texels;
    const uint64_t room = address_texels > used ? (address_texels - used) / layer : 0;
    uint64_t classes = 1;
    for (uint32_t finer = 2 * side; finer <= finest; finer *= 2) ++classes;
    const uint64_t share = std::max(room / classes, std::min<uint64_t>(room, 6)),
                   in_image = std::min<uint64_t>(demand.most_layers, image_texels / layer);
    if (in_image >= 6) add_images(layout, side, std::min(share, wanted) / 6 * 6, static_cast<uint32_t>(in_image));
  }
  number_layers(layout);
  // What finds no image of its size must find an ordinary one: a small map in a sparse image would have no memory.
  layout.most_views = ordinary_views;
  const uint64_t bytes = demand.texels * form.texel_bytes(), ordinary_bytes = out.ordinary_texels * form.texel_bytes();
  out.pages = static_cast<uint32_t>(bytes > ordinary_bytes ? (bytes - ordinary_bytes) / kSparsePageBytes : 0);
  return out;
}

}  // namespace umbrage::store
