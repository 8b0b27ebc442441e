// Boxes → lights that reach them → marks in these lights' maps.
#include "maps/other_receivers.hpp"

#include <algorithm>
#include <cstddef>

namespace umbrage::maps {

namespace {
constexpr uint32_t kReach[] =
#include "shaders/reach_boxes.comp.inc"
    ;
constexpr uint32_t kMark[] =
#include "shaders/mark_boxes.comp.inc"
    ;
static_assert(sizeof(Aabb) == sizeof(shared::Box));

bool are_anywhere(std::span<const CameraDesc> cameras) {
  return std::any_of(cameras.begin(), cameras.end(), [](const CameraDesc& camera) {
    return camera.other_receivers && camera.other_receivers_ws.empty();
  });
}

/// The boxes that a camera's other receivers lie in.
std::span<const Aabb> boxes_of(const CameraDesc& camera) {
  return camera.other_receivers ? camera.other_receivers_ws : std::span<const Aabb>();
}

size_t count_boxes(std::span<const CameraDesc> cameras) {
  if (are_anywhere(cameras)) return 0;
  size_t count = 0;
  for (const CameraDesc& camera : cameras) count += boxes_of(camera).size();
  return count;
}
}  // namespace

Result<OtherReceivers> OtherReceivers::create(const gpu::PipelineFactory& factory) {
  OtherReceivers out;
  auto reach = factory.compute(kReach, "reach boxes");
  if (!reach) return reach.error();
  out.reach_ = std::move(*reach);
  auto mark = factory.compute(kMark, "mark boxes");
  if (!mark) return mark.error();
  out.mark_ = std::move(*mark);
  return out;
}

Result<void> OtherReceivers::reserve(const gpu::Device& device, gpu::Memory& memory,
                                     std::span<const CameraDesc> cameras, std::vector<gpu::Buffer>& retired) {
  const VkDeviceSize bytes = count_boxes(cameras) * sizeof(shared::Box);
  if (bytes <= boxes_.size()) return {};
  return gpu::grow(boxes_, device, memory, 2 * bytes, "boxes of other receivers", retired);
}

VkDeviceSize OtherReceivers::staged_bytes(std::span<const CameraDesc> cameras) {
  return count_boxes(cameras) * sizeof(shared::Box) + 16 * cameras.size();
}

void OtherReceivers::upload(gpu::Uploader& uploader, std::span<const CameraDesc> cameras) {
  anywhere_ = are_anywhere(cameras);
  count_ = 0;
  for (const CameraDesc& camera : cameras) {
    if (anywhere_) return;
    const std::span<const Aabb> boxes = boxes_of(camera);
    uploader.copy(boxes_, count_ * sizeof(shared::Box), boxes.data(), boxes.size_bytes());
    count_ += static_cast<uint32_t>(boxes.size());
  }
}

void OtherReceivers::record_lights(gpu::Recorder& recorder, const scene::GpuScene& scene,
                                   const gpu::Buffer& used_lights) {
  if (count_ == 0 || scene.light_slots() == 0) return;
  gpu::Scope scope(recorder, "reach boxes");
  gpu::Pass pass = recorder.pass("reach boxes");
  const shared::ReachBoxesPush push{.lights = pass.read(scene.light_buffer()),
                                    .boxes = pass.read(boxes_),
                                    .used = pass.write(used_lights),
                                    .light_slots = scene.light_slots(),
                                    .box_count = count_};
  pass.dispatch(reach_, push, (scene.light_slots() + 63) / 64,
                (count_ + shared::BoxesAtOnce - 1) / shared::BoxesAtOnce);
}

void OtherReceivers::record_marks(gpu::Recorder& recorder, const Marks& in) {
  if (count_ == 0) return;
  gpu::Pass pass = recorder.pass("mark boxes");
  pass.read(in.counters, gpu::Access::indirect_read), pass.read(in.lights), pass.read(in.views);
  pass.write(in.maps), pass.write(in.page_bits), pass.write(in.projection), pass.write(in.receiver_depth);
  const shared::MarkBoxesPush push{.frame = pass.read(in.frame),
                                   .counters = pass.read(in.counters),
                                   .boxes = pass.read(boxes_),
                                   .box_count = count_};
  pass.dispatch_indirect(mark_, push, in.counters, offsetof(shared::FrameCounters, fit_map_groups));
}

}  // namespace umbrage::maps
