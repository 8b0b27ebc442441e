// Files that are either whole or not there: written under a temporary name beside the target, then renamed; removed
// when the work fails or the program is interrupted.
#pragma once
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "umbrage/result.hpp"

namespace app {

class OutputFile;

/// Knows the temporary files of this process. On SIGINT and SIGTERM it removes them, then the signal ends the process.
/// One per process, made in main before any other thread, because the signals stay blocked in every thread.
class Outputs {
 public:
  Outputs();
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// The target's folder must exist. A target that is no regular file (a pipe, /dev/null) is written in place.
  umbrage::Result<OutputFile> open(const std::filesystem::path& target);

 private:
  friend class OutputFile;
  struct State;
  std::shared_ptr<State> state_;  // Kept alive by the watching thread and by files still open.
};

/// Move-only. What has not been committed is gone with the object.
class OutputFile {
 public:
  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) noexcept;
  ~OutputFile();

  umbrage::Result<void> write(std::span<const std::byte> bytes);
  umbrage::Result<void> write(std::string_view text);
  /// Flushes, checks and renames. To be called once; afterwards only destruction is allowed.
  umbrage::Result<void> commit();

 private:
  friend class Outputs;
  OutputFile(std::shared_ptr<Outputs::State> state, std::FILE* file, std::filesystem::path target,
             std::filesystem::path temporary);
  umbrage::Error failure(const char* action) const;
  void discard();

  std::shared_ptr<Outputs::State> state_;
  std::FILE* file_ = nullptr;
  std::filesystem::path target_, temporary_;  // temporary_ is empty when the target is written in place.
};

/// What would make open() fail, told before long work: a missing folder, or one that cannot be written. "-" is fine.
umbrage::Result<void> check_target(const std::filesystem::path& target);

umbrage::Result<void> write_standard_output(std::string_view text);

/// A whole text file. "-" is standard output.
umbrage::Result<void> write_text(Outputs& outputs, const std::filesystem::path& target, std::string_view text);

}  // namespace app
