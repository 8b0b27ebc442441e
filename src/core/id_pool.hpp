// Slots behind public ids. An id is a slot and the generation of its use, so that a stale one is recognised; a slot whose
// generations are used up is never handed out again.
#pragma once
#include <cstdint>
#include <vector>

namespace umbrage {

template <class T>
class IdPool {
 public:
  static constexpr uint32_t kSlotBits = 20;
  static constexpr uint32_t kMaxSlots = 1u << kSlotBits;
  static constexpr uint32_t kMaxGeneration = (1u << (32 - kSlotBits)) - 1;

  bool full() const { return free_.empty() && entries_.size() >= kMaxSlots; }
  /// 0 when full.
  uint32_t add(T value) {
    uint32_t slot;
    if (!free_.empty()) {
      slot = free_.back();
      free_.pop_back();
    } else {
      if (full()) return 0;
      slot = static_cast<uint32_t>(entries_.size());
      entries_.push_back({});
    }
    Entry& entry = entries_[slot];
    entry.value = std::move(value);
    entry.alive = true;
    ++entry.generation;
    ++count_;
    return entry.generation << kSlotBits | slot;
  }
  /// nullptr for ids that are stale or were never handed out.
  T* find(uint32_t id) {
    const uint32_t slot = id & (kMaxSlots - 1);
    if (slot >= entries_.size()) return nullptr;
    Entry& entry = entries_[slot];
    return entry.alive && entry.generation == id >> kSlotBits ? &entry.value : nullptr;
  }
  const T* find(uint32_t id) const { return const_cast<IdPool*>(this)->find(id); }
  /// Precondition: find(id).
  void remove(uint32_t id) {
    retire(id);
    release(slot_of(id));
  }
  /// As remove, but the slot is not handed out again before release(). Precondition: find(id).
  void retire(uint32_t id) {
    Entry& entry = entries_[slot_of(id)];
    entry.alive = false;
    entry.value = {};
    --count_;
  }
  /// Precondition: the slot was retired.
  void release(uint32_t slot) {
    if (entries_[slot].generation < kMaxGeneration) free_.push_back(slot);
  }
  static uint32_t slot_of(uint32_t id) { return id & (kMaxSlots - 1); }
  uint32_t slots() const { return static_cast<uint32_t>(entries_.size()); }
  uint32_t count() const { return count_; }
  bool alive(uint32_t slot) const { return entries_[slot].alive; }
  T& at(uint32_t slot) { return entries_[slot].value; }
  const T& at(uint32_t slot) const { return entries_[slot].value; }
  uint32_t id_at(uint32_t slot) const { return entries_[slot].generation << kSlotBits | slot; }

 private:
  struct Entry {
    T value{};
    uint32_t generation = 0;
    bool alive = false;
  };
  std::vector<Entry> entries_;
  std::vector<uint32_t> free_;
  uint32_t count_ = 0;
};

}  // namespace umbrage
