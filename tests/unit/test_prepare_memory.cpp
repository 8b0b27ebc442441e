// Memory runs out at every place in turn: an error, no exception, nothing lost (the address sanitizer's build looks).
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "umbrage/prepare.hpp"

namespace {

/// Allocations of this thread that still succeed; negative: all.
thread_local int left = -1;

void* allocate(size_t size) {
  if (left == 0) throw std::bad_alloc();
  if (left > 0) --left;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(size_t size) { return allocate(size); }
void* operator new[](size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t) noexcept { std::free(memory); }

namespace {

using umbrage::ErrorCode;

/// Calls with 0, 1, 2… allocations until the outcome is not out_of_memory; how many failed before.
template <class Call>
int failures_before_success(const Call& call, ErrorCode& last) {
  for (int allowed = 0;; ++allowed) {
    left = allowed;
    const auto result = call();
    left = -1;
    last = result.ok() ? ErrorCode::out_of_memory : result.error().code;
    if (result.ok() || last != ErrorCode::out_of_memory) return allowed;
  }
}

TEST(PrepareMemory, PrepareMeshReportsEveryFailedAllocation) {
  std::vector<umbrage::Vec3> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 600; ++i) {
    positions.push_back({static_cast<float>(i * 7919 % 101), static_cast<float>(i), 0});
    indices.push_back(i);
  }
  ErrorCode last{};
  EXPECT_GT(failures_before_success([&] { return umbrage::prepare_mesh(positions, indices, {}, {}); }, last), 20);
}

TEST(PrepareMemory, AMessageThatFindsNoMemoryIsStillAnError) {
  const std::vector<uint32_t> indices{0, 1};
  ErrorCode last{};
  EXPECT_GT(failures_before_success([&] { return umbrage::prepare_mesh({}, indices, {}, {}); }, last), 0);
  EXPECT_EQ(last, ErrorCode::invalid_argument);
  const std::vector<std::byte> bytes(100);
  EXPECT_GT(failures_before_success([&] { return umbrage::open_prepared(bytes); }, last), 0);
  EXPECT_EQ(last, ErrorCode::invalid_argument);
}

}  // namespace
