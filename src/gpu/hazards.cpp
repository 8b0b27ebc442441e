// Plain and slow: every access against every earlier one of its resource back to the last write that orders the rest.
#include "gpu/hazards.hpp"

#include <cstring>
#include <map>

namespace umbrage::gpu {

namespace {
constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                                   VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

/// True if some barrier after `from` and before `to` orders and, where needed, makes memory visible.
bool ordered(const HazardLog& log, size_t from, size_t to) {
  const HazardEvent& a = log[from];
  const HazardEvent& b = log[to];
  VkPipelineStageFlags2 execution = 0;   // stages of b that wait for a
  VkAccessFlags2 visible = 0;
  for (size_t i = from + 1; i < to; ++i) {
    const HazardEvent& barrier = log[i];
    if (barrier.kind != HazardEvent::Kind::barrier || barrier.resource != a.resource) continue;
    if ((barrier.stages & a.stages) != a.stages) continue;
    const bool covers_memory = !a.writes || (barrier.access & a.access & kWrites) == (a.access & kWrites);
    execution |= barrier.dst_stages;
    if (covers_memory) visible |= barrier.dst_access;
  }
  if ((execution & b.stages) != b.stages) return false;
  return !a.writes || (visible & b.access) == b.access;
}
}  // namespace

std::vector<Hazard> find_hazards(const HazardLog& log) {
  std::vector<Hazard> hazards;
  std::map<const void*, std::vector<size_t>> history;  // accesses of a resource
  for (size_t i = 0; i < log.size(); ++i) {
    const HazardEvent& now = log[i];
    if (now.kind != HazardEvent::Kind::access) continue;
    std::vector<size_t>& before = history[now.resource];
    for (size_t k = before.size(); k-- > 0;) {
      const HazardEvent& then = log[before[k]];
      if (then.pass == now.pass) continue;
      if (!then.writes && !now.writes) continue;
      if (!ordered(log, before[k], i))
        hazards.push_back({std::string(now.pass) + (now.writes ? " writes " : " reads ") + now.resource_name + " after " +
                           then.pass + (then.writes ? " wrote" : " read") + " it, unordered"});
      if (then.writes) break;  // whatever came earlier is ordered before that write, or was reported there
    }
    before.push_back(i);
  }
  return hazards;
}

}  // namespace umbrage::gpu
