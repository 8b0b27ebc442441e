#include "page_rig.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace umbrage::test {

PageMap cube_map(const glm::vec3& origin, float near_m, uint32_t resolution, double marked) {
  PageMap map{shared::ViewsCube, resolution, {}, marked};
  for (uint32_t face = 0; face < shared::CubeFaceCount; ++face)
    map.views.push_back(shared::perspective_view(origin, near_m, shared::face_rotation(face), 1));
  return map;
}

PageMap spot_map(const glm::vec3& origin, const glm::vec3& direction, float cone_rad, float near_m, uint32_t resolution,
                 double marked) {
  return {shared::ViewsSpot,
          resolution,
          {shared::perspective_view(origin, near_m, shared::view_rotation(direction), std::tan(cone_rad))},
          marked};
}

PageMap ortho_map(const glm::vec3& direction, const glm::vec3& box_min, const glm::vec3& box_max, uint32_t resolution,
                  double marked) {
  return {shared::ViewsOrtho,
          resolution,
          {shared::ortho_view(direction, box_min, box_max, std::max(resolution, 16u), 3)},
          marked};
}

PageRig::PageRig(Gpu& gpu, const TestScene& test_scene, std::vector<PageMap> maps, uint32_t seed)
    : gpu_(gpu),
      test_scene_(test_scene),
      maps_(std::move(maps)),
      scene_(gpu.device(), gpu.memory(), {}),
      casters_(add_casters(gpu, scene_, test_scene)) {
  gpu::Uploader uploader;
  take(scene_.upload(uploader, retired_, 1));
  const scene::ScenePipelines pipelines = take(scene::ScenePipelines::create(gpu.factory()));
  gpu.run([&](VkCommandBuffer commands) {
    gpu::Recorder recorder = gpu.recorder(commands);
    scene_.record(recorder, pipelines, uploader, retired_, 1);
  });
  std::mt19937 engine(seed);
  lay_out(engine);
  list_items(seed, false);
}

void PageRig::lay_out(std::mt19937& engine) {
  std::uniform_real_distribution<double> chance(0, 1);
  std::vector<shared::ShadowView> views;
  std::vector<uint32_t> bits, first;
  uint32_t units = 0;
  for (const PageMap& map : maps_) {
    shared::MapRecord record{};
    record.first_view = static_cast<uint32_t>(views.size());
    record.view_count = static_cast<uint32_t>(map.views.size());
    record.kind = map.kind;
    record.resolution = map.resolution;
    record.pages = shared::pages_of(map.resolution);
    record.words = shared::page_words_of(record.pages);
    record.first_word = static_cast<uint32_t>(bits.size());
    record.receivers = map.whole ? shared::ReceiversAnywhere : shared::ReceiversInSight;
    for (uint32_t view = 0; view < record.view_count; ++view) {
      for (uint32_t word = 0; word < record.words; ++word) {
        uint32_t marks = 0;
        units += static_cast<uint32_t>(engine() % 5);  // nobody's
        const uint32_t word_first = units;
        for (uint32_t bit = 0; bit < 32 && word * 32 + bit < record.pages * record.pages; ++bit) {
          if (chance(engine) >= map.marked) continue;
          const uint32_t page = word * 32 + bit;
          pages_.push_back({static_cast<uint32_t>(records_.size()), view,
                            glm::uvec2(page % record.pages, page / record.pages) * shared::PageSide,
                            shared::page_side_of(map.resolution), units * shared::PoolUnit});
          units += shared::page_units_of(map.resolution);
          marks |= 1u << bit;
        }
        bits.push_back(marks);
        first.push_back(word_first);
      }
    }
    views.insert(views.end(), map.views.begin(), map.views.end());
    records_.push_back(record);
  }
  views_ = gpu_.upload(views);
  map_buffer_ = gpu_.upload(records_);
  page_bits_ = gpu_.upload(bits);
  page_first_ = gpu_.upload(first);
  pool_ = gpu_.buffer(VkDeviceSize(units) * shared::PoolUnit * sizeof(uint32_t), gpu::MemoryKind::device, "pool");
  record_.views = views_.address();
  record_.maps = map_buffer_.address();
  record_.page_bits = page_bits_.address();
  record_.page_first = page_first_.address();
  record_.pool = pool_.address();
  frame_ = gpu_.upload(&record_, sizeof record_);
}

void PageRig::list_items(uint32_t seed, bool by_face) {
  const auto casters = gpu_.download<shared::CasterRecord>(scene_.caster_buffer(), scene_.caster_slots());
  const auto batches = gpu_.download<shared::BatchRecord>(scene_.batch_buffer(),
                                                          scene_.batch_buffer().size() / sizeof(shared::BatchRecord));
  std::mt19937 engine(seed);
  for (auto& list : items_) list.clear();
  for (uint32_t caster = 0; caster < casters.size(); ++caster) {
    if (casters[caster].instance == shared::NoIndex) continue;
    auto& list = items_[batches[casters[caster].batch].mask != shared::NoIndex];
    for (uint32_t map = 0; map < records_.size(); ++map) {
      const uint32_t all = (1u << records_[map].view_count) - 1;
      if (!by_face) list.push_back({caster, map, all});
      for (uint32_t face = 0; by_face && face < records_[map].view_count; ++face)
        list.push_back({caster, map, 1u << face});
    }
  }
  for (auto& list : items_) std::shuffle(list.begin(), list.end(), engine);
  capacity_ = static_cast<uint32_t>(std::max(items_[0].size(), items_[1].size())) + 3;
  std::vector<shared::CasterItem> all(2 * size_t(capacity_), {0, 0, 0});
  std::copy(items_[0].begin(), items_[0].end(), all.begin());
  std::copy(items_[1].begin(), items_[1].end(), all.begin() + capacity_);
  item_buffer_ = gpu_.upload(all);
  const shared::DrawCounts counts{static_cast<uint32_t>(items_[0].size()), static_cast<uint32_t>(items_[1].size())};
  counts_ = gpu_.upload(&counts, sizeof counts);
}

raster::PageWriterInputs PageRig::inputs() const {
  return {scene_,
          frame_,
          views_,
          map_buffer_,
          page_bits_,
          page_first_,
          pool_,
          item_buffer_,
          counts_,
          capacity_,
          nullptr,
          nullptr,
          texel_bits_.empty() ? nullptr : &looked_up_};
}

void PageRig::look_up(double share, uint32_t seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> chance(0, 1);
  texel_bits_.assign(pool_.size() / sizeof(uint32_t) / shared::PoolUnit, 0);
  for (uint32_t& word : texel_bits_)
    for (uint32_t bit = 0; bit < 32; ++bit) word |= uint32_t(chance(engine) < share) << bit;
  looked_up_ = gpu_.upload(texel_bits_);
  record_.texel_bits = looked_up_.address();
  frame_ = gpu_.upload(&record_, sizeof record_);
}

uint32_t PageRig::max_resolution() const {
  return std::max_element(maps_.begin(), maps_.end(),
                          [](const PageMap& a, const PageMap& b) { return a.resolution < b.resolution; })
      ->resolution;
}

void PageRig::clear() {
  gpu_.run([&](VkCommandBuffer commands) {
    gpu::Recorder recorder = gpu_.recorder(commands);
    gpu::Pass pass = recorder.pass("clear pool");
    pass.write(pool_, gpu::Access::transfer_write);
    recorder.device().vk().vkCmdFillBuffer(pass.commands(), pool_.handle(), 0, VK_WHOLE_SIZE, 0);
  });
}

void PageRig::run(const Write& write, gpu::HazardLog* log) {
  gpu_.run([&](VkCommandBuffer commands) {
    gpu::Recorder recorder = gpu_.recorder(commands, log);
    write(recorder, inputs());
  });
}

reference::DepthWindow PageRig::reference(const Page& page) const {
  const PageMap& map = maps_[page.map];
  const shared::ShadowView& view = map.views[0];
  reference::DepthWindow window(map.resolution, page.first, page.side);
  for (const TestInstance& instance : test_scene_.instances) {
    const TestMesh& mesh = test_scene_.meshes[instance.mesh];
    const float* m = instance.world_from_mesh.m;
    const glm::vec3 translation = glm::vec3(m[3], m[7], m[11]) - view.origin;
    for (size_t i = 0; mesh.uvs.empty() && i < mesh.indices.size(); i += 3) {
      std::array<glm::vec4, 3> clip;
      for (size_t k = 0; k < 3; ++k) {
        const glm::vec3 p = to_glm(mesh.positions[mesh.indices[i + k]]);
        const glm::vec3 turned(glm::dot(glm::vec3(m[0], m[1], m[2]), p), glm::dot(glm::vec3(m[4], m[5], m[6]), p),
                               glm::dot(glm::vec3(m[8], m[9], m[10]), p));
        clip[k] = shared::clip_position(view, map.kind, page.view, turned + translation);
      }
      reference::draw_triangle(window, clip);
    }
  }
  return window;
}

}  // namespace umbrage::test
