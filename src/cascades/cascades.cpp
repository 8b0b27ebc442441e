// Notes what moved → plans → scrolls C → lists ΔS and A → draws ΔS onto C → copies C to W → draws A onto W.
#include "cascades/cascades.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace umbrage::cascades {

namespace {
constexpr uint32_t kNote[] =
#include "shaders/note_moved.comp.inc"
    ;
constexpr uint32_t kPlan[] =
#include "shaders/plan_cascades.comp.inc"
    ;
constexpr uint32_t kScroll[] =
#include "shaders/scroll_maps.comp.inc"
    ;
constexpr uint32_t kList[] =
#include "shaders/list_casters.comp.inc"
    ;
constexpr uint32_t kPlanDraws[] =
#include "shaders/plan_draws.comp.inc"
    ;
constexpr uint32_t kDraw[] =
#include "shaders/draw_casters.comp.inc"
    ;
constexpr uint32_t kDrawLarge[] =
#include "shaders/draw_large.comp.inc"
    ;
constexpr uint32_t kCompose[] =
#include "shaders/compose_maps.comp.inc"
    ;
/// Triangles that wait for a workgroup of their own; more are drawn by a thread each.
constexpr uint32_t kLargeTriangles = 1u << 16;
/// Texels along a cell's side, squared.
constexpr uint32_t kCell = shared::CellTexels * shared::CellTexels;

void fill(gpu::Recorder& recorder, const gpu::Buffer& buffer, const char* name) {
  gpu::Pass pass = recorder.pass(name);
  pass.write(buffer, gpu::Access::transfer_write);
  recorder.device().vk().vkCmdFillBuffer(pass.commands(), buffer.handle(), 0, VK_WHOLE_SIZE, 0);
}
}  // namespace

Result<void> Cascades::prepare(const gpu::PipelineFactory& factory) {
  if (note_.handle()) return {};
  const struct {
    gpu::Pipeline& target;
    std::span<const uint32_t> spirv;
    const char* name;
    uint32_t masked = 0;
  } all[] = {{plan_, kPlan, "plan cascades"},
             {scroll_, kScroll, "scroll maps"},
             {list_, kList, "list casters"},
             {plan_draws_, kPlanDraws, "plan draws"},
             {compose_, kCompose, "compose maps"},
             {draw_[0], kDraw, "draw casters"},
             {draw_[1], kDraw, "draw casters, masked", 1},
             {draw_large_[0], kDrawLarge, "draw large triangles"},
             {draw_large_[1], kDrawLarge, "draw large triangles, masked", 1},
             {note_, kNote, "note moved casters"}};  // the last tells that all are there
  for (const auto& entry : all) {
    auto made = factory.compute(entry.spirv, entry.name, {{0, entry.masked}});
    if (!made) return made.error();
    entry.target = std::move(*made);
  }
  return {};
}

/// Times grow with every frame, or a caster that moved in this one could look as if it had stood still in the last.
void Cascades::tick(double time_s) {
  if (begins_) {
    first_time_s_ = time_s;
    table_.before = 0;
    table_.now = 1;
    return;
  }
  const double ticks = (time_s - first_time_s_) * shared::TicksPerSecond;
  table_.before = table_.now;
  table_.now = std::max(table_.now + 1, static_cast<uint32_t>(std::clamp(ticks, 0.0, double(shared::NeverMoves - 1))));
}

Result<void> Cascades::begin(const gpu::Device& device, gpu::Memory& memory, const scene::GpuScene& scene,
                             const FrameInputs& in, std::vector<gpu::Buffer>& retired) {
  begins_ = !is_recorded_ || table_.now >= shared::NeverMoves / 2;
  is_recorded_ = false;
  tick(in.time_s);
  const size_t lights = std::min<size_t>(in.lights.size(), shared::MaxCascades / in.settings.count);
  const auto records = planner_.plan(in.camera, in.lights.first(lights), in.settings, !begins_);
  std::copy(records.begin(), records.end(), table_.records);
  most_side_ = records.empty() ? 0 : records[0].side;
  table_.texels = planner_.texels();
  if (3ull * table_.texels > UINT32_MAX)
    return Error{ErrorCode::invalid_argument,
                 "cascades: " + std::to_string(records.size()) + " of " + std::to_string(records[0].side) +
                     " texels a side are more than 32 bits can number; lower cascade_resolution or cascade_count"};
  table_.cascades = static_cast<uint32_t>(records.size());
  table_.count = in.settings.count;
  table_.static_after = in.settings.static_after;
  table_.blend = in.settings.blend;
  const VkBuffer former_maps = maps_.handle();
  if (auto ok = reserve(device, memory, std::max(scene.caster_slots(), 1u), retired); !ok) return ok;
  for (shared::CascadeRecord& record : std::span(table_.records, table_.cascades)) {
    if (in.fresh || maps_.handle() != former_maps) record.flags &= ~shared::CascadeHolds;
    if (in.fresh) record.flags |= shared::CascadeAllStatic;
  }
  table_.states = states_.address();
  table_.maps = maps_.address();
  table_.farthest = farthest_.address();
  table_.moved_at = moved_at_.buffer().address();
  table_.known_boxes = known_boxes_.buffer().address();
  return {};
}

Result<void> Cascades::reserve(const gpu::Device& device, gpu::Memory& memory, uint32_t casters,
                               std::vector<gpu::Buffer>& retired) {
  const uint32_t texels = std::max(table_.texels, kCell), items = casters * std::max(table_.cascades, 1u);
  const bool had_states = static_cast<bool>(states_);
  const struct {
    gpu::Buffer& buffer;
    VkDeviceSize bytes;
    const char* name;
  } needs[] = {{table_buffer_, sizeof table_, "cascades"},
               {states_, shared::MaxCascades * sizeof(shared::CascadeState), "cascade states"},
               {arguments_, sizeof(shared::CascadeArguments), "cascade arguments"},
               {maps_, 3ull * texels * sizeof(uint32_t), "cascade maps"},
               {farthest_, texels / kCell * sizeof(uint32_t), "farthest depths of cells"},
               {items_, 2ull * items * sizeof(shared::CascadeItem), "cascade items"},
               {larges_, kLargeTriangles * sizeof(shared::GridTriangle), "large triangles of cascades"}};
  for (const auto& need : needs)
    if (auto ok = gpu::grow(need.buffer, device, memory, need.bytes, need.name, retired); !ok) return ok;
  states_are_new_ = states_are_new_ || !had_states;
  item_capacity_ = items;
  if (auto ok = moved_at_.ensure(device, memory, casters * sizeof(uint32_t), "times of casters"); !ok) return ok;
  return known_boxes_.ensure(device, memory, casters * sizeof(shared::Box), "known boxes");
}

void Cascades::upload(gpu::Uploader& uploader) const { uploader.copy(table_buffer_, 0, &table_, sizeof table_); }

uint32_t Cascades::row_groups() const { return (most_side_ / shared::CellTexels * most_side_ + 63) / 64; }

void Cascades::write_maps(gpu::Pass& pass) const {
  pass.read(table_buffer_);
  pass.write(states_);
  pass.write(maps_);
  pass.write(farthest_);
}

void Cascades::record(gpu::Recorder& recorder, const Inputs& in, gpu::RetireQueue& retired) {
  if (states_are_new_) fill(recorder, states_, "clear cascade states");
  states_are_new_ = false;
  moved_at_.record(recorder, retired, in.serial);
  known_boxes_.record(recorder, retired, in.serial);
  shared::CascadePush push{.table = table_buffer_.address(),
                           .arguments = arguments_.address(),
                           .casters = in.scene.caster_buffer().address(),
                           .instances = in.scene.instance_buffer().address()};
  record_moved(recorder, in, push);
  is_recorded_ = true;
  if (table_.cascades == 0) return;
  record_scroll(recorder, push);
  record_lists(recorder, in);
  record_draws(recorder, in, push, false);
  {
    gpu::Scope compose(recorder, "cascades: compose");
    clear_cells(recorder);
    gpu::Pass pass = recorder.pass("compose maps");
    write_maps(pass);
    pass.dispatch(compose_, push, row_groups(), table_.cascades);
  }
  record_draws(recorder, in, push, true);
}

void Cascades::record_moved(gpu::Recorder& recorder, const Inputs& in, shared::CascadePush& push) {
  push.moved = begins_ ? 0 : in.scene.moved_casters();
  push.count = begins_ ? in.scene.caster_slots() : in.scene.moved_caster_count();
  if (push.count == 0) return;
  gpu::Scope scope(recorder, "cascades: note moved");
  gpu::Pass pass = recorder.pass("note moved casters");
  pass.read(table_buffer_), pass.read(in.scene.caster_buffer()), pass.read(in.scene.instance_buffer());
  pass.write(states_), pass.write(moved_at_.buffer()), pass.write(known_boxes_.buffer());
  push.boxes = pass.read(in.scene.caster_boxes());
  pass.dispatch(note_, push, (push.count + 63) / 64);
}

void Cascades::clear_cells(gpu::Recorder& recorder) { fill(recorder, farthest_, "clear cells"); }

void Cascades::record_scroll(gpu::Recorder& recorder, shared::CascadePush& push) {
  gpu::Scope scope(recorder, "cascades: scroll");
  {
    gpu::Pass pass = recorder.pass("plan cascades");
    pass.read(table_buffer_);
    pass.write(states_);
    pass.write(arguments_);
    pass.dispatch(plan_, push, 1);
  }
  clear_cells(recorder);
  gpu::Pass pass = recorder.pass("scroll maps");
  write_maps(pass);
  pass.dispatch(scroll_, push, row_groups(), table_.cascades);
}

void Cascades::record_lists(gpu::Recorder& recorder, const Inputs& in) {
  gpu::Scope scope(recorder, "cascades: list");
  const scene::BoxTree& tree = in.scene.caster_tree();
  gpu::Pass pass = recorder.pass("list casters");
  pass.read(in.frame);
  pass.read(moved_at_.buffer());
  pass.write(states_);
  const shared::ListCascadesPush push{.table = pass.read(table_buffer_),
                                      .arguments = pass.write(arguments_),
                                      .items = pass.write(items_),
                                      .casters = pass.read(in.scene.caster_buffer()),
                                      .instances = pass.read(in.scene.instance_buffer()),
                                      .batches = pass.read(in.scene.batch_buffer()),
                                      .order = pass.read(tree.order()),
                                      .leaves = pass.read(tree.leaves()),
                                      .nodes = pass.read(tree.nodes()),
                                      .shape = in.tree_shape,
                                      .counters = in.counters.address(),
                                      .capacity = item_capacity_};
  pass.dispatch(list_, push, table_.cascades);
}

void Cascades::record_plan_draws(gpu::Recorder& recorder, shared::CascadePush& push, uint32_t step) {
  gpu::Pass pass = recorder.pass("plan draws");
  pass.write(arguments_);
  push.step = step;
  push.count = kLargeTriangles;
  pass.dispatch(plan_draws_, push, 1);
}

void Cascades::record_draws(gpu::Recorder& recorder, const Inputs& in, shared::CascadePush& push, bool actives) {
  const bool masked = in.scene.has_masked();
  record_plan_draws(recorder, push, actives ? shared::PlanActives : shared::PlanStatics);
  shared::DrawCascadesPush draw{.table = table_buffer_.address(),
                                .arguments = arguments_.address(),
                                .larges = larges_.address(),
                                .large_capacity = kLargeTriangles,
                                .draws_actives = actives};
  {
    gpu::Scope scope(recorder, actives ? "cascades: draw active" : "cascades: draw static");
    gpu::Pass pass = recorder.pass("draw casters");
    write_maps(pass);
    pass.read(arguments_, gpu::Access::indirect_read);
    pass.write(arguments_);
    pass.write(larges_);
    draw.items = pass.read(items_) + (actives ? item_capacity_ * sizeof(shared::CascadeItem) : 0);
    draw.casters = pass.read(in.scene.caster_buffer()), draw.instances = pass.read(in.scene.instance_buffer());
    draw.batches = pass.read(in.scene.batch_buffer()), draw.indices = pass.read(in.scene.index_buffer());
    draw.boxes = pass.read(in.scene.caster_boxes());
    pass.dispatch_indirect(draw_[masked], draw, arguments_,
                           actives ? offsetof(shared::CascadeArguments, active_groups)
                                   : offsetof(shared::CascadeArguments, static_groups));
  }
  record_plan_draws(recorder, push, shared::PlanLarges);
  gpu::Scope scope(recorder, "cascades: draw large");
  gpu::Pass pass = recorder.pass("draw large triangles");
  write_maps(pass);
  pass.read(arguments_, gpu::Access::indirect_read);
  pass.read(arguments_);
  pass.read(larges_);
  pass.read(in.scene.batch_buffer());
  pass.dispatch_indirect(draw_large_[masked], draw, arguments_, offsetof(shared::CascadeArguments, large_groups));
}

void Cascades::record_statistics(gpu::Recorder& recorder, const gpu::Buffer& target) const {
  {
    gpu::Pass pass = recorder.pass("cascade statistics");
    pass.read(states_, gpu::Access::transfer_read);
    pass.write(target, gpu::Access::transfer_write);
    const VkBufferCopy region{0, 0, states_.size()};
    recorder.device().vk().vkCmdCopyBuffer(pass.commands(), states_.handle(), target.handle(), 1, &region);
  }
  gpu::Pass pass = recorder.pass("cascade statistics to host");
  pass.read(target, gpu::Access::host_read);
  pass.commands();
}

}  // namespace umbrage::cascades
