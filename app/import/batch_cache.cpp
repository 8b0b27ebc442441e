// One file per mesh, named by its key. What a file says is believed only after open_prepared or detail_levels_of has checked it.
#include "import/batch_cache.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "import/meshoptimizer_library.hpp"

namespace app {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view BatchesExtension = ".umbp", LevelsExtension = ".umbl";

fs::path file_name(uint64_t key, std::string_view extension) {
  std::array<char, 16> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), key, 16).ptr;
  const std::string_view hex(digits.data(), end);
  return std::string(digits.size() - hex.size(), '0') + std::string(hex) + std::string(extension);
}

/// Also what an interrupted run left behind: a key, the extension, perhaps a random suffix.
bool is_ours(const fs::path& file) {
  const std::string name = file.filename().string();
  const auto extension = std::string_view(name).substr(std::min<size_t>(name.size(), 16), BatchesExtension.size());
  return name.find_first_not_of("0123456789abcdef") == 16 &&
         (extension == BatchesExtension || extension == LevelsExtension);
}

/// More than prepare_mesh makes of so many indices, whatever the settings: a longer file is not worth reading.
uint64_t most_bytes(size_t index_count) { return 4096 + uint64_t{index_count} / 3 * 64; }

std::optional<std::vector<std::byte>> read(const fs::path& file, uint64_t most) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  const uintmax_t size = fs::file_size(file, error);
  if (error || size > most) return {};
  std::vector<std::byte> bytes(size);
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) return {};
  return bytes;
}

/// The key is a hash; the counts make a collision harmless for whoever indexes with the result.
bool belongs_to(std::span<const std::byte> bytes, uint64_t key, size_t position_count, size_t index_count,
                size_t submesh_count) {
  const auto mesh = umbrage::open_prepared(bytes);
  return mesh && mesh->key == key && mesh->mesh_vertex_count == position_count &&
         mesh->local_indices.size() + mesh->wide_indices.size() == index_count && mesh->submesh_count == submesh_count;
}

/// The name of a new file beside `target`, empty if none can be made.
fs::path write_beside(const fs::path& target, std::span<const std::byte> bytes) {
  std::string name = target.string() + ".XXXXXX";
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) return {};
  close(descriptor);
  std::ofstream stream(name, std::ios::binary | std::ios::trunc);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (stream) return name;
  std::error_code ignored;
  fs::remove(name, ignored);
  return {};
}

}  // namespace

BatchCache::BatchCache(fs::path folder, uint64_t limit_bytes) : folder_(std::move(folder)), limit_bytes_(limit_bytes) {}

umbrage::Result<std::vector<std::byte>> BatchCache::prepare(std::span<const umbrage::Vec3> positions,
                                                            std::span<const uint32_t> indices,
                                                            std::span<const umbrage::Submesh> submeshes,
                                                            const umbrage::PrepareSettings& settings) {
  if (folder_.empty()) return umbrage::prepare_mesh(positions, indices, submeshes, settings);
  try {
    const uint64_t key = umbrage::prepare_key(positions, indices, submeshes, settings);
    const fs::path file = folder_ / file_name(key, BatchesExtension);
    const size_t submesh_count = std::max<size_t>(submeshes.size(), 1);
    auto kept = read(file, most_bytes(indices.size()));
    if (kept && belongs_to(*kept, key, positions.size(), indices.size(), submesh_count)) {
      found(file);
      return std::move(*kept);
    }
    auto made = umbrage::prepare_mesh(positions, indices, submeshes, settings);
    if (made) store(file, *made);
    return made;
  } catch (const std::bad_alloc&) { return umbrage::Error{umbrage::ErrorCode::out_of_memory, "batch cache"}; }
}

DetailLevels BatchCache::levels(std::span<const glm::vec3> positions, std::span<const uint32_t> indices) {
  if (folder_.empty() || indices.size() <= MostUnsimplifiedIndices) return make_detail_levels(positions, indices);
  const uint64_t key = detail_levels_key(positions, indices);
  const fs::path file = folder_ / file_name(key, LevelsExtension);
  try {
    // All coarser levels have at most three times the triangles of the finest, in a quarter of the bytes of its batches.
    if (const auto kept = read(file, most_bytes(2 * indices.size()))) {
      if (auto levels = detail_levels_of(*kept, key, positions.size(), indices)) {
        found(file);
        return std::move(*levels);
      }
    }
  } catch (const std::bad_alloc&) {}  // Made anew.
  DetailLevels made = make_detail_levels(positions, indices);
  try {
    if (made.errors_m.size() > 1 || meshoptimizer_library()) store(file, bytes_of(made, key));
  } catch (const std::bad_alloc&) {}  // Not kept.
  return made;
}

void BatchCache::found(const fs::path& file) {
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);  // What prune() goes by.
  ++hits_;
}

void BatchCache::store(const fs::path& file, std::span<const std::byte> bytes) {
  if (bytes.size() > limit_bytes_) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return;
  const fs::path temporary = write_beside(file, bytes);
  if (temporary.empty()) return;
  fs::rename(temporary, file, error);
  if (error) {
    fs::remove(temporary, error);
    return;
  }
  held_bytes_ += bytes.size();
  if (!scanned_ || held_bytes_ > limit_bytes_) prune();
}

/// Counts what there is; when it is too much, removes the oldest down to three quarters, so that the next scan is far off.
void BatchCache::prune() {
  struct File {
    fs::path path;
    uint64_t size;
    fs::file_time_type used;
  };
  std::vector<File> files;
  uint64_t total = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unreadable;
    if (!is_ours(entry->path()) || !entry->is_regular_file(unreadable)) continue;
    const uint64_t size = entry->file_size(unreadable);
    if (unreadable) continue;
    const fs::file_time_type used = entry->last_write_time(unreadable);
    if (unreadable) continue;
    total += size;
    files.push_back({entry->path(), size, used});
  }
  scanned_ = true;
  held_bytes_ = total;
  if (total <= limit_bytes_) return;
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.used < b.used; });
  // The newest is what was just stored.
  for (size_t i = 0; i + 1 < files.size() && held_bytes_ > limit_bytes_ / 4 * 3; ++i) {
    if (fs::remove(files[i].path, error)) held_bytes_ -= files[i].size;
  }
}

}  // namespace app
