// Files for importer tests: real scenes where they are, and small documents written for one test.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/gltf_import.hpp"

namespace import_test {

/// A file or folder of the real scenes; empty when it is not there.
std::filesystem::path scene_file(std::string_view relative);

/// .gltf and .glb files below a folder, sorted.
std::vector<std::filesystem::path> gltf_files(const std::filesystem::path& folder);

/// A folder of its own that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

/// Imports a document given as JSON text.
umbrage::Result<app::Scene> import_text(const std::string& json);

/// "data:application/octet-stream;base64,…" of values in memory order.
std::string data_uri(std::span<const std::byte> bytes);
template <class T>
std::string data_uri(const std::vector<T>& values) {
  return data_uri(std::as_bytes(std::span(values)));
}

/// Values as bytes, one array after the other.
class Bytes {
 public:
  template <class T>
  Bytes& add(const std::vector<T>& values) {
    append(std::as_bytes(std::span(values)));
    return *this;
  }
  size_t size() const { return bytes_.size(); }
  /// `"buffers": [...]` with these bytes as the only buffer.
  std::string buffers() const;

 private:
  void append(std::span<const std::byte>);

  std::vector<std::byte> bytes_;
};

/// Runs in a child process with this much more address space and 60 s of processor time: what an import may take when
/// a file is small. True: the function returned true.
bool succeeds_within(size_t extra_address_space, const std::function<bool()>&);

}  // namespace import_test

/// ASSERTs that a Result<Scene> is a scene.
#define ASSERT_LOADS(result) ASSERT_TRUE((result).ok()) << (result).error().message
/// EXPECTs an error whose message holds a text.
#define EXPECT_REFUSED(result, text)                                          \
  do {                                                                        \
    const auto& refused_result = (result);                                    \
    EXPECT_FALSE(refused_result.ok());                                        \
    if (!refused_result.ok()) {                                               \
      EXPECT_NE(refused_result.error().message.find(text), std::string::npos) \
          << "message: " << refused_result.error().message;                   \
    }                                                                         \
  } while (false)
