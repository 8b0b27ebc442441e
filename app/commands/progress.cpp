// A line of progress on a terminal.
#include "commands/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace app {

Progress::Progress() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() { clear(); }

void Progress::show(const std::string& what, uint64_t done, uint64_t total) {
  if (!is_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (is_drawn_ && what == what_ && now - drawn_at_ < std::chrono::milliseconds(100)) return;
  const std::string count = total > 0 ? std::string(" ") + std::to_string(done) + "/" + std::to_string(total) : "";
  std::fprintf(stderr, "\r\x1b[Kumbrage: %s%s", what.c_str(), count.c_str());
  std::fflush(stderr);
  is_drawn_ = true;
  what_ = what;
  drawn_at_ = now;
}

void Progress::clear() {
  if (!is_drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  is_drawn_ = false;
}

}  // namespace app
