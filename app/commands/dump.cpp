// --dump.
#include "commands/dump.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <vector>

#include "commands/lights_file.hpp"
#include "commands/npy.hpp"
#include "commands/parse.hpp"
#include "commands/stats_json.hpp"

namespace app {
namespace {

namespace fs = std::filesystem;
using umbrage::Result;

constexpr uint64_t kChunkBytes = 64ull << 20;  // Visibility read back at once.

/// The folder, made when missing; one that this run made goes again when nothing was put into it.
class Folder {
 public:
  static Result<Folder> open(const fs::path& path) {
    std::error_code code;
    const bool is_new = fs::create_directories(path, code);
    if (code) return invalid("--dump: " + path.string() + ": cannot be made: " + code.message());
    return Folder(path, is_new);
  }
  Folder(Folder&& other) noexcept : path_(std::move(other.path_)), is_new_(std::exchange(other.is_new_, false)) {}
  Folder& operator=(Folder&&) = delete;
  ~Folder() {
    std::error_code ignored;
    if (is_new_ && fs::is_empty(path_, ignored)) fs::remove(path_, ignored);
  }
  fs::path file(const char* name) const { return path_ / name; }

 private:
  Folder(fs::path path, bool is_new) : path_(std::move(path)), is_new_(is_new) {}
  fs::path path_;
  bool is_new_;
};

Result<NpyWriter> write_vectors(Outputs& outputs, const fs::path& target, const Extent& size,
                                const Result<std::vector<float>>& values) {
  if (!values) return values.error();
  const uint64_t shape[] = {size.height, size.width, 3};
  auto writer = NpyWriter::create(outputs, target, NpyType::float32, shape);
  if (!writer) return writer.error();
  if (const auto appended = writer->append(*values); !appended) return appended.error();
  return writer;
}

/// Reads runs of neighbouring lights in chunks, so that no more than a chunk is ever held.
Result<NpyWriter> write_visibility(Session& session, Outputs& outputs, const fs::path& target,
                                   std::span<const uint32_t> lights, Progress& progress) {
  const Extent& size = session.options().size;
  const uint64_t pixels = uint64_t(size.width) * size.height;
  const uint64_t shape[] = {lights.size(), size.height, size.width};
  auto writer = NpyWriter::create(outputs, target, NpyType::uint8, shape);
  if (!writer) return writer.error();
  const size_t chunk = std::max<uint64_t>(1, kChunkBytes / pixels);
  std::vector<uint8_t> visibility;
  for (size_t first = 0; first < lights.size();) {
    size_t count = 1;
    while (count < chunk && first + count < lights.size() && lights[first + count] == lights[first] + count) ++count;
    progress.show("dumping lights", first + count, lights.size());
    visibility.resize(count * pixels);
    const auto read = session.renderer().read_visibility(lights[first], static_cast<uint32_t>(count), visibility, {});
    if (!read) return read.error();
    if (const auto appended = writer->append(visibility); !appended) return appended.error();
    first += count;
  }
  return writer;
}

Result<std::vector<uint32_t>> chosen_lights(const Session& session) {
  const auto count = static_cast<uint32_t>(session.lights().size());
  const std::vector<IndexRange>& ranges = session.options().dump_lights;
  if (!ranges.empty()) {
    auto indices = expand_indices(ranges, count);
    if (!indices) return invalid("--dump-lights: " + indices.error().message);
    return indices;
  }
  std::vector<uint32_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

}  // namespace

Result<void> write_dump(Session& session, Outputs& outputs, Progress& progress) {
  const auto chosen = chosen_lights(session);
  if (!chosen) return chosen.error();
  const auto folder = Folder::open(session.options().dump_folder);
  if (!folder) return folder.error();
  const Extent& size = session.options().size;
  Renderer& renderer = session.renderer();
  progress.show("dumping arrays");
  auto position = write_vectors(outputs, folder->file("position.npy"), size, renderer.read_position());
  if (!position) return position.error();
  auto normal = write_vectors(outputs, folder->file("normal.npy"), size, renderer.read_normal());
  if (!normal) return normal.error();
  auto color = write_vectors(outputs, folder->file("color.npy"), size, renderer.read_color());
  if (!color) return color.error();
  auto visibility = write_visibility(session, outputs, folder->file("visibility.npy"), *chosen, progress);
  if (!visibility) return visibility.error();

  std::vector<ActiveLight> lights;
  for (const uint32_t index : *chosen) lights.push_back(session.lights()[index]);
  auto list = outputs.open(folder->file("lights.json"));
  if (!list) return list.error();
  if (const auto written = list->write(to_text(lights_document(lights))); !written) return written.error();

  for (NpyWriter* array : {&*position, &*normal, &*color, &*visibility})
    if (const auto committed = array->commit(); !committed) return committed.error();
  return list->commit();
}

}  // namespace app
