// Files that are either whole or not there.
#include "commands/output.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "commands/parse.hpp"

namespace app {
namespace fs = std::filesystem;

namespace {

/// Those that would end the process: a parent that has one ignored (nohup, a shell's background job) keeps its will.
sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : {SIGINT, SIGTERM}) {
    struct sigaction current {};
    if (sigaction(number, nullptr, &current) == 0 && current.sa_handler != SIG_IGN) sigaddset(&signals, number);
  }
  return signals;
}

}  // namespace

struct Outputs::State {
  std::mutex mutex;  // Held while a file is renamed or removed, so that a signal finds either name but not neither.
  std::set<fs::path> temporaries;
  uint32_t next_number = 0;
  int signal_fd = -1, stop_fd = -1;
  std::thread watcher;

  void watch() {
    pollfd sources[2] = {{signal_fd, POLLIN, 0}, {stop_fd, POLLIN, 0}};
    while (poll(sources, 2, -1) >= 0 || errno == EINTR) {
      if (sources[1].revents != 0) return;
      signalfd_siginfo received{};
      if ((sources[0].revents & POLLIN) && read(signal_fd, &received, sizeof received) == sizeof received)
        end_by(static_cast<int>(received.ssi_signo));
    }
  }

  void end_by(int signal_number) {
    const std::lock_guard lock(mutex);
    for (const fs::path& path : temporaries) unlink(path.c_str());
    // Dying of the signal itself tells the parent (a shell, a script) the truth.
    std::signal(signal_number, SIG_DFL);
    const sigset_t signals = ending_signals();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    std::raise(signal_number);
  }
};

Outputs::Outputs() : state_(std::make_shared<State>()) {
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  state_->signal_fd = signalfd(-1, &signals, SFD_CLOEXEC);
  state_->stop_fd = eventfd(0, EFD_CLOEXEC);
  if (state_->signal_fd < 0 || state_->stop_fd < 0) {
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // Out of descriptors: the signals end the process as usual.
    return;
  }
  state_->watcher = std::thread([state = state_.get()] { state->watch(); });
}

Outputs::~Outputs() {
  if (state_->watcher.joinable()) {
    const uint64_t one = 1;
    if (write(state_->stop_fd, &one, sizeof one) == sizeof one)
      state_->watcher.join();
    else
      state_->watcher.detach();
  }
  for (const int descriptor : {state_->signal_fd, state_->stop_fd})
    if (descriptor >= 0) close(descriptor);
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

umbrage::Result<OutputFile> Outputs::open(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) return invalid(target.string() + ": is a folder, not a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    std::FILE* file = std::fopen(target.c_str(), "wb");
    if (!file) return invalid(target.string() + ": cannot be opened for writing: " + std::strerror(errno));
    return OutputFile(state_, file, target, {});
  }
  // A link stays a link: what it names is replaced.
  fs::path real_target = fs::weakly_canonical(target, ignored);
  if (real_target.empty()) real_target = target;
  const std::lock_guard lock(state_->mutex);
  for (int attempt = 0; attempt < 1000; ++attempt) {
    fs::path temporary = real_target;
    const uint32_t number = state_->next_number++;
    temporary.concat(".").concat(std::to_string(getpid())).concat("-").concat(std::to_string(number)).concat(".tmp");
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) return invalid(target.string() + ": cannot be written: " + std::strerror(errno));
    state_->temporaries.insert(temporary);
    return OutputFile(state_, fdopen(descriptor, "wb"), std::move(real_target), std::move(temporary));
  }
  return invalid(target.string() + ": no free temporary name beside it");
}

OutputFile::OutputFile(std::shared_ptr<Outputs::State> state, std::FILE* file, fs::path target, fs::path temporary)
    : state_(std::move(state)), file_(file), target_(std::move(target)), temporary_(std::move(temporary)) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : state_(std::move(other.state_)),
      file_(std::exchange(other.file_, nullptr)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  state_ = std::move(other.state_);
  file_ = std::exchange(other.file_, nullptr);
  target_ = std::move(other.target_);
  temporary_ = std::exchange(other.temporary_, {});
  return *this;
}

OutputFile::~OutputFile() { discard(); }

umbrage::Error OutputFile::failure(const char* action) const {
  return invalid(target_.string() + ": cannot be " + action + ": " + std::strerror(errno));
}

void OutputFile::discard() {
  if (file_) std::fclose(std::exchange(file_, nullptr));
  if (temporary_.empty()) return;
  const std::lock_guard lock(state_->mutex);
  unlink(temporary_.c_str());
  state_->temporaries.erase(std::exchange(temporary_, {}));
}

umbrage::Result<void> OutputFile::write(std::span<const std::byte> bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) return failure("written");
  return {};
}

umbrage::Result<void> OutputFile::write(std::string_view text) {
  return write(std::as_bytes(std::span(text.data(), text.size())));
}

umbrage::Result<void> OutputFile::commit() {
  if (std::fclose(std::exchange(file_, nullptr)) != 0) return failure("written");
  if (temporary_.empty()) return {};
  const std::lock_guard lock(state_->mutex);
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) return failure("put in place");
  state_->temporaries.erase(std::exchange(temporary_, {}));
  return {};
}

umbrage::Result<void> check_target(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) return invalid(target.string() + ": is a folder, not a file");
  if (target == "-" || (fs::exists(status) && !fs::is_regular_file(status))) return {};
  fs::path folder = fs::weakly_canonical(target, ignored).parent_path();
  if (folder.empty()) folder = ".";
  if (access(folder.c_str(), W_OK | X_OK) == 0) return {};
  return invalid(target.string() + ": cannot be written: " + std::strerror(errno));
}

umbrage::Result<void> write_standard_output(std::string_view text) {
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!is_written) return invalid(std::string("standard output cannot be written: ") + std::strerror(errno));
  return {};
}

umbrage::Result<void> write_text(Outputs& outputs, const fs::path& target, std::string_view text) {
  if (target == "-") return write_standard_output(text);
  auto file = outputs.open(target);
  if (!file) return file.error();
  if (const auto written = file->write(text); !written) return written.error();
  return file->commit();
}

}  // namespace app
