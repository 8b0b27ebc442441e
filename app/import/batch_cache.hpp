// What is made of meshes once, batches and levels of detail, kept on disk between runs and found again by the content it was made from.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "import/detail_levels.hpp"
#include "umbrage/prepare.hpp"

namespace app {

/// A folder of prepared meshes and levels. A folder that cannot be made, read or written only costs the time that it would have saved.
/// Several processes may share one: files appear whole, by renaming. Not thread-safe itself.
class BatchCache {
 public:
  static constexpr uint64_t DefaultLimitBytes = uint64_t{512} << 20;

  /// The folder is made when first needed; an empty path keeps nothing. Files of the least recent use go when there are more
  /// than limit_bytes; files that are not the cache's are never touched.
  explicit BatchCache(std::filesystem::path folder, uint64_t limit_bytes = DefaultLimitBytes);

  /// umbrage::prepare_mesh, or its bytes of an earlier time. A damaged or foreign file is made anew. Errors: those of
  /// prepare_mesh only.
  umbrage::Result<std::vector<std::byte>> prepare(std::span<const umbrage::Vec3> positions,
                                                  std::span<const uint32_t> indices,
                                                  std::span<const umbrage::Submesh> submeshes,
                                                  const umbrage::PrepareSettings& settings);

  /// make_detail_levels, or its levels of an earlier time; likewise.
  DetailLevels levels(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

  uint64_t hits() const { return hits_; }

 private:
  void found(const std::filesystem::path& file);
  void store(const std::filesystem::path& file, std::span<const std::byte> bytes);
  void prune();

  std::filesystem::path folder_;
  uint64_t limit_bytes_;
  uint64_t held_bytes_ = 0;  ///< As far as known: after the last scan, and what was stored since.
  bool scanned_ = false;
  uint64_t hits_ = 0;
};

}  // namespace app
