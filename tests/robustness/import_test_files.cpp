// Files and limits for importer tests.
#include "import_test_files.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

namespace import_test {

namespace fs = std::filesystem;

fs::path scene_file(std::string_view relative) {
  const fs::path path = fs::path(UMBRAGE_SCENES_DIR) / relative;
  return fs::exists(path) ? path : fs::path();
}

std::vector<fs::path> gltf_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path extension = entry.path().extension();
    if (extension == ".gltf" || extension == ".glb") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "umbrage-import-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder " + name);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path TemporaryFolder::write(const std::string& name, std::string_view content) const {
  std::ofstream file(path_ / name, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!file) throw std::runtime_error("cannot write " + name);
  return path_ / name;
}

umbrage::Result<app::Scene> import_text(const std::string& json) {
  const TemporaryFolder folder;
  return app::import_gltf(folder.write("test.gltf", json));
}

std::string data_uri(std::span<const std::byte> bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = "data:application/octet-stream;base64,";
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? std::to_integer<uint32_t>(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

void Bytes::append(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

std::string Bytes::buffers() const {
  return R"("buffers": [{"byteLength": )" + std::to_string(size()) + R"(, "uri": ")" +
         data_uri(std::span<const std::byte>(bytes_)) + "\"}]";
}

namespace {

size_t address_space_now() {
  std::ifstream statm("/proc/self/statm");
  size_t pages = 0;
  statm >> pages;
  return pages * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

bool succeeds_within(size_t extra_address_space, const std::function<bool()>& function) {
  const pid_t child = fork();
  if (child == 0) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their shadow memory is address space too
    const rlimit memory{address_space_now() + extra_address_space, RLIM_INFINITY};
    setrlimit(RLIMIT_AS, &memory);
#else
    (void)extra_address_space, (void)address_space_now;
#endif
    const rlimit time{60, 60};
    setrlimit(RLIMIT_CPU, &time);
    _exit(function() ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return false;
  return WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS;
}

}  // namespace import_test
