// Plain and slow: every access against every earlier one of its resource back to the last write that orders the rest.
#include "gpu/hazards.hpp"

#include <cstring>
#include <map>

namespace umbrage::gpu {

namespace {
constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                   VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

bool changes_layout(const HazardEvent& event) {
  return event.kind == HazardEvent::Kind::barrier && event.layout != event.old_layout;
}

/// True if the barriers after `from` and before `to` (or at `to`, a change of layout) order the two and, where needed, make
/// memory visible.
bool ordered(const HazardLog& log, size_t from, size_t to) {
  const HazardEvent& a = log[from];
  const HazardEvent& b = log[to];
  const bool from_layout = changes_layout(a), to_layout = changes_layout(b);
  const VkPipelineStageFlags2 a_stages = from_layout ? a.dst_stages : a.stages;
  const VkAccessFlags2 a_writes = from_layout ? 0 : a.writes ? a.access & kWrites : 0;
  const bool needs_memory = from_layout || a.writes;
  if (to_layout) return (b.stages & a_stages) == a_stages && (b.access & a_writes) == a_writes;
  VkPipelineStageFlags2 execution = from_layout ? a.dst_stages : 0;  // stages of b that wait for a
  VkAccessFlags2 visible = from_layout ? a.dst_access : 0;
  for (size_t i = from + 1; i < to; ++i) {
    const HazardEvent& barrier = log[i];
    if (barrier.kind != HazardEvent::Kind::barrier || barrier.resource != a.resource) continue;
    if ((barrier.stages & a_stages) != a_stages) continue;
    execution |= barrier.dst_stages;
    if ((barrier.access & a_writes) == a_writes) visible |= barrier.dst_access;
  }
  if ((execution & b.stages) != b.stages) return false;
  return !needs_memory || (visible & b.access) == b.access;
}

std::string does(const HazardEvent& event) {
  return changes_layout(event) ? " changes the layout of " : event.writes ? " writes " : " reads ";
}
std::string did(const HazardEvent& event) {
  return changes_layout(event) ? " changed its layout" : event.writes ? " wrote it" : " read it";
}
}  // namespace

std::vector<Hazard> find_hazards(const HazardLog& log) {
  struct History {
    std::vector<size_t> uses;  // accesses and changes of layout
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  };
  std::vector<Hazard> hazards;
  std::map<uint64_t, History> histories;
  for (size_t i = 0; i < log.size(); ++i) {
    const HazardEvent& now = log[i];
    const bool now_layout = changes_layout(now);
    if (now.kind == HazardEvent::Kind::barrier && !now_layout) continue;
    History& history = histories[now.resource];
    const bool keeps = !now_layout || now.old_layout != VK_IMAGE_LAYOUT_UNDEFINED;
    if (keeps && (now_layout ? now.old_layout : now.layout) != history.layout)
      hazards.push_back({std::string(now.pass) + does(now) + now.resource_name + ", which is in another layout"});
    if (now_layout) history.layout = now.layout;
    for (size_t k = history.uses.size(); k-- > 0;) {
      const HazardEvent& then = log[history.uses[k]];
      const bool then_changes = then.writes || changes_layout(then);
      if (then.pass_number == now.pass_number && !changes_layout(then)) continue;
      if (!then_changes && !now.writes && !now_layout) continue;
      if (!ordered(log, history.uses[k], i))
        hazards.push_back({std::string(now.pass) + does(now) + now.resource_name + " after " + then.pass + did(then) +
                           ", unordered"});
      if (then_changes) break;  // whatever came earlier is ordered before that write, or was reported there
    }
    history.uses.push_back(i);
  }
  return hazards;
}

}  // namespace umbrage::gpu
