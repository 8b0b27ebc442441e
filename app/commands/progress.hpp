// A line of progress on a terminal; nothing at all when standard error is not one.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace app {

class Progress {
 public:
  Progress();
  /// Erases the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// "umbrage: rendering 12/60"; drawn at most ten times a second.
  void show(const std::string& what, uint64_t done = 0, uint64_t total = 0);
  void clear();

 private:
  bool is_terminal_;
  bool is_drawn_ = false;
  std::string what_;
  std::chrono::steady_clock::time_point drawn_at_;
};

}  // namespace app
