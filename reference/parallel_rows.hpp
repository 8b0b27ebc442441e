// Runs a function for every row of an image on all processors.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <system_error>
#include <thread>
#include <vector>

namespace reference {

/// Calls row(y) once for each y < rows, in any order, from several threads; returns when all are done. row must not
/// throw.
template <class Row>
void parallel_rows(uint32_t rows, const Row& row) {
  std::atomic<uint32_t> next{0};
  const auto work = [&] {
    for (uint32_t y = next++; y < rows; y = next++) row(y);
  };
  const uint32_t wanted = std::min(std::max(1u, std::thread::hardware_concurrency()), rows);
  std::vector<std::jthread> helpers;
  helpers.reserve(wanted);
  try {
    while (helpers.size() + 1 < wanted) helpers.emplace_back(work);
  } catch (const std::system_error&) {
    // No more threads to be had: those there are, and this one, do all rows.
  }
  work();
}

}  // namespace reference
