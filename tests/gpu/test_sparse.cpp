// Maps in sparse images (O13): the same answers as from the page pool, memory where lookups touch and nowhere else (O15, O18),
// over frames and budgets; and refusals that say why.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pair_rig.hpp"

namespace umbrage::test {
namespace {

class HardwareSparse : public GpuTest {};

constexpr uint32_t kReadWords[] =
#include "shaders/read_words.comp.inc"
    ;

StaticSettings sparse(uint32_t budget_mib = 256) {
  return {.store = Store::hardware_sparse, .sparse_texels = SparseTexels::words, .budget_mib = budget_mib};
}

/// Exact layout, one resolution that is whole pages in both stores; the writer that both have.
FrameSettings frozen(uint32_t resolution, Store store, CasterCulling culling = CasterCulling::receiver_grid) {
  return {.layout = MapLayout::exact,
          .maps_per_light = 1,
          .caster_culling = culling,
          .writer = store == Store::page_pool ? Writer::fragments : Writer::automatic,
          .min_resolution = resolution,
          .max_resolution = resolution};
}

struct Texel {
  uint32_t word, resident;
};

/// Reads the corners of layers of the images that a rig's maps lie in.
class LayerReader {
 public:
  explicit LayerReader(SystemRig& rig) : gpu_(rig.gpu()) {
    const VkDevice device = gpu_.desc().device;
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                                               nullptr};
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = 1, info.pBindings = &binding;
    check(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout_), "vkCreateDescriptorSetLayout");
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, shared::MaxMapImages};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = shared::MaxMapImages, pool.poolSizeCount = 1, pool.pPoolSizes = &size;
    check(vkCreateDescriptorPool(device, &pool, nullptr, &pool_), "vkCreateDescriptorPool");
    for (const gpu::Image& image : rig.stages().sparse.images().images()) {
      VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
      allocation.descriptorPool = pool_, allocation.descriptorSetCount = 1, allocation.pSetLayouts = &layout_;
      check(vkAllocateDescriptorSets(device, &allocation, &sets_.emplace_back()), "vkAllocateDescriptorSets");
      const VkDescriptorImageInfo view{VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL};
      VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
      write.dstSet = sets_.back(), write.descriptorCount = 1, write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
      write.pImageInfo = &view;
      vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
    program_ = std::make_unique<Program>(gpu_, kReadWords, std::span(&layout_, 1));
  }
  LayerReader(const LayerReader&) = delete;
  ~LayerReader() {
    vkDestroyDescriptorPool(gpu_.desc().device, pool_, nullptr);
    vkDestroyDescriptorSetLayout(gpu_.desc().device, layout_, nullptr);
  }
  std::vector<Texel> read(uint32_t image, uint32_t layer, uint32_t side) {
    struct Push {
      VkDeviceAddress target;
      uint32_t layer, side;
    };
    const gpu::Buffer target = gpu_.buffer(size_t(side) * side * sizeof(Texel), gpu::MemoryKind::device, "words");
    gpu_.run([&](VkCommandBuffer commands) {
      program_->dispatch(commands, sets_[image], Push{target.address(), layer, side}, (side + 15) / 16,
                         (side + 15) / 16);
    });
    return gpu_.download<Texel>(target, size_t(side) * side);
  }

 private:
  Gpu& gpu_;
  VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::vector<VkDescriptorSet> sets_;
  std::unique_ptr<Program> program_;
};

// --- The equality class -----------------------------------------------------------------------------------------------------

TEST_F(HardwareSparse, AnswersBitByBitAsThePagePool) {
  const SeenScene scene = balls_scene(60, 12, 81);
  PairRig pages(gpu(), {}, scene), images(gpu(), sparse(), scene);
  for (const uint32_t resolution : {16u, 32u, 256u, 512u, 1024u}) {
    SCOPED_TRACE(std::to_string(resolution) + " texels");
    const Pairs expected = pages.settle(frozen(resolution, Store::page_pool)),
                answers = images.settle(frozen(resolution, Store::hardware_sparse));
    ASSERT_EQ(answers.visibility.size(), expected.visibility.size());
    EXPECT_EQ(differences(expected, answers), 0u);
    EXPECT_TRUE(pages.system().degraded_lights().empty() && images.system().degraded_lights().empty());
    EXPECT_GT(expected.asked(), 1000u);
    EXPECT_EQ(expected.statistics.bytes_read_back, 0u);
    EXPECT_EQ(answers.statistics.bytes_read_back > sizeof(uint64_t), resolution >= 256) << "small maps need no pages";
  }
}

TEST_F(HardwareSparse, AnswersAsThePagePoolInHardScenes) {
  const std::vector<SeenScene> scenes = hard_scenes();
  PairRig pages(gpu(), {}, scenes[0]), images(gpu(), sparse(), scenes[0]);
  for (const SeenScene& scene : scenes) {
    if (&scene != &scenes[0]) pages.replace(scene), images.replace(scene);
    EXPECT_EQ(
        differences(pages.settle(frozen(256, Store::page_pool)), images.settle(frozen(256, Store::hardware_sparse))),
        0u)
        << scene.name;
  }
}

TEST_F(HardwareSparse, HoldsThePagePoolsTexelsPageForPage) {
  const SeenScene scene = balls_scene(40, 12, 82);
  PairRig pages(gpu(), {}, scene), images(gpu(), sparse(), scene);
  // Not culled by receivers: every marked texel is drawn alike.
  pages.settle(frozen(512, Store::page_pool, CasterCulling::view_mask));
  images.settle(frozen(512, Store::hardware_sparse, CasterCulling::view_mask));
  const DeviceMaps in_pages(pages), in_images(images);
  ASSERT_EQ(in_pages.maps.size(), in_images.maps.size());
  const auto pool =
      gpu().download<uint32_t>(pages.stages().pool.pool(), size_t(in_pages.counters.pool_units) * shared::PoolUnit);
  LayerReader reader(images);
  size_t texels = 0, drawn = 0, wrong = 0;
  for (size_t m = 0; m < in_pages.maps.size(); ++m) {
    const shared::MapRecord &map = in_pages.maps[m], &other = in_images.maps[m];
    ASSERT_EQ(map.resolution, other.resolution);
    for (uint32_t view = 0; view < map.view_count; ++view) {
      if ((map.faces >> view & 1) == 0) continue;
      const std::vector<Texel> words = reader.read(other.image, other.layer + view, map.resolution);
      for (uint32_t y = 0; y < map.resolution; ++y)
        for (uint32_t x = 0; x < map.resolution; ++x) {
          const shared::PagePlace place = shared::page_place(map, view, {x, y}),
                                  other_place = shared::page_place(other, view, {x, y});
          const uint32_t bits = in_pages.page_bits[place.word];
          const bool marked = (bits >> place.bit & 1) != 0;
          ASSERT_EQ(marked, (in_images.page_bits[other_place.word] >> other_place.bit & 1) != 0);
          if (!marked) continue;
          const uint32_t expected =
              pool[shared::page_texel(bits, in_pages.page_first[place.word], place.bit, map.resolution) +
                   shared::texel_in_page({x, y}, map.resolution)];
          ++texels, drawn += expected > 0, wrong += words[size_t(y) * map.resolution + x].word != expected;
        }
    }
  }
  EXPECT_GT(texels, 300000u);
  EXPECT_GT(drawn, texels / 30);
  EXPECT_EQ(wrong, 0u) << "of " << texels;
}

TEST_F(HardwareSparse, AnswersTheSameWhateverIsCulled) {
  const SeenScene scene = balls_scene(60, 40, 83);
  PairRig rig(gpu(), sparse(), scene);
  for (FrameSettings settings :
       {FrameSettings{},
        FrameSettings{.layout = MapLayout::exact, .resolution = ResolutionForm::paper, .maps_per_light = 4}}) {
    settings.caster_culling = CasterCulling::light_volume;
    const Pairs all = rig.settle(settings);
    for (const CasterCulling culling : {CasterCulling::view_mask, CasterCulling::projection_map,
                                        CasterCulling::projection_map_depth, CasterCulling::receiver_grid}) {
      settings.caster_culling = culling;
      EXPECT_EQ(differences(all, rig.settle(settings)), 0u) << "culling " << int(culling);
    }
  }
}

/// Whole pages, or less than 64 texels; and as fine as asked where there are few lights.
TEST_F(HardwareSparse, RoundsResolutionsUpToPages) {
  PairRig rig(gpu(), sparse(), balls_scene(30, 12, 91, 320, 224));
  const uint32_t page = rig.stages().sparse.form().page.x;
  uint32_t small = 0, whole = 0;
  for (const uint32_t undersampling : {1u, 2u, 4u}) {
    const FrameSettings settings{
        .layout = MapLayout::exact, .maps_per_light = 4, .undersampling = undersampling, .min_resolution = 4};
    rig.settle(settings);
    EXPECT_TRUE(rig.system().degraded_lights().empty());
    const DeviceMaps maps(rig);
    for (const shared::MapRecord& map : maps.maps) {
      EXPECT_EQ(map.resolution, map.asked);
      ++(map.resolution < shared::LeastSparseSide ? small : whole);
      EXPECT_TRUE(map.resolution < shared::LeastSparseSide || map.resolution % page == 0) << map.resolution;
    }
    for (size_t pair = 0; pair < maps.pair_maps.size(); ++pair)
      if (maps.pair_maps[pair] != shared::NoIndex) {
        EXPECT_GE(float(maps.maps[maps.pair_maps[pair]].resolution) + 1e-3f, maps.pair_requests[pair]);
      }
  }
  EXPECT_GT(small, 5u);
  EXPECT_GT(whole, 5u);
}

// --- Residency ----------------------------------------------------------------------------------------------------------------

/// What is marked, as the pages that hold it; from the device's tables.
std::set<std::array<uint32_t, 4>> pages_of(const DeviceMaps& maps, const glm::uvec2& page) {
  std::set<std::array<uint32_t, 4>> out;
  for (const shared::MapRecord& map : maps.maps) {
    if (map.resolution < shared::LeastSparseSide) continue;
    for (uint32_t view = 0; view < map.view_count; ++view)
      for (uint32_t y = 0; y < map.resolution; y += shared::PageSide)
        for (uint32_t x = 0; x < map.resolution; x += shared::PageSide) {
          const shared::PagePlace place = shared::page_place(map, view, {x, y});
          if (maps.page_bits[place.word] >> place.bit & 1)
            out.insert({map.image, map.layer + view, x / page.x, y / page.y});
        }
  }
  return out;
}

void expect_bound(PairRig& rig) {
  const DeviceMaps maps(rig);
  const store::SparseImages& images = rig.stages().sparse;
  const auto needed = pages_of(maps, images.form().page);
  std::set<std::array<uint32_t, 4>> bound;
  for (const store::BoundPage& page : images.residency().resident())
    bound.insert(
        {page.page.image_layer >> 16, page.page.image_layer & 0xffff, page.page.place & 0xffff, page.page.place >> 16});
  EXPECT_EQ(bound, needed);
  EXPECT_EQ(maps.counters.pages, needed.size());
  EXPECT_LE(bound.size(), images.layout().pages);
}

/// O15: residency codes name the pages that were bound, and nothing has been written anywhere else.
TEST_F(HardwareSparse, WritesNothingWhereNothingIsBound) {
  if (!gpu().desc().enabled.shader_residency) GTEST_SKIP() << "shaders cannot ask what is resident";
  const SeenScene scene = balls_scene(60, 20, 84);
  PairRig rig(gpu(), sparse(), scene);
  const FrameSettings settings{
      .layout = MapLayout::exact, .caster_culling = CasterCulling::view_mask, .min_resolution = 512};
  rig.settle(settings);
  expect_bound(rig);
  const DeviceMaps maps(rig);
  const glm::uvec2 page = rig.stages().sparse.form().page;
  const auto bound = pages_of(maps, page);
  LayerReader reader(rig);
  size_t resident = 0, absent = 0, wrong_codes = 0, written = 0;
  for (const shared::MapRecord& map : maps.maps) {
    if (map.resolution < shared::LeastSparseSide) continue;
    for (uint32_t view = 0; view < map.view_count; ++view) {
      const std::vector<Texel> texels = reader.read(map.image, map.layer + view, map.resolution);
      for (uint32_t y = 0; y < map.resolution; ++y)
        for (uint32_t x = 0; x < map.resolution; ++x) {
          const Texel& texel = texels[size_t(y) * map.resolution + x];
          const bool is_bound = bound.contains({map.image, map.layer + view, x / page.x, y / page.y});
          wrong_codes += (texel.resident != 0) != is_bound;
          ++(is_bound ? resident : absent);
          written += !is_bound && texel.word != 0;
        }
    }
  }
  EXPECT_EQ(wrong_codes, 0u);
  EXPECT_EQ(written, 0u);
  EXPECT_GT(resident, 100000u);
  EXPECT_GT(absent, 100000u);
}

TEST_F(HardwareSparse, BindsWhatFramesAskForAndNoMore) {
  SeenScene scene = balls_scene(40, 40, 85);
  const SeenScene other = balls_scene(30, 60, 86);
  PairRig rig(gpu(), sparse(), scene);
  const FrameSettings settings = frozen(512, Store::hardware_sparse);
  const Pairs first = rig.settle(settings);
  EXPECT_GT(first.statistics.pages_resident, 100u);
  expect_bound(rig);
  const Pairs still = rig.evaluate(settings);
  EXPECT_EQ(differences(first, still), 0u);
  EXPECT_EQ(still.statistics.pages_bound + still.statistics.pages_unbound, 0u) << "nothing moves";
  EXPECT_EQ(still.statistics.bytes_read_back,
            sizeof(shared::SparseRequests) + still.statistics.pages_resident * sizeof(shared::SparsePage));

  uint64_t changed = 0;
  const CameraDesc cameras[] = {perspective_camera({12, 4, 9}, {0, 1, 0}, 96, 64),
                                perspective_camera({-3, 7, 5}, {1, 0, -2}, 96, 64), scene.camera};
  for (const CameraDesc& camera : cameras) {
    scene.camera = camera;
    scene.seen = picture(camera, balls_on_ground);
    rig.replace(scene);
    const Pairs answers = rig.settle(settings);
    EXPECT_EQ(differences(answers, PairRig(gpu(), sparse(), scene).settle(settings)), 0u);
    expect_bound(rig);
    changed += answers.statistics.pages_bound;
  }
  rig.replace(other);
  EXPECT_EQ(differences(rig.settle(settings), PairRig(gpu(), sparse(), other).settle(settings)), 0u);
  expect_bound(rig);
  rig.replace(balls_scene(10, 0, 87));  // no light, no page
  rig.settle(settings);
  EXPECT_TRUE(rig.stages().sparse.residency().resident().empty());
  EXPECT_GT(changed, 0u);
}

/// As a host that waits for nothing itself: a fence tells the library that requests have finished, a semaphore holds raster back.
TEST_F(HardwareSparse, BindsBehindAFenceAndBeforeASemaphore) {
  const SeenScene scene = balls_scene(40, 20, 92);
  PairRig rig(gpu(), sparse(), scene), other(gpu(), sparse(), scene);
  const FrameSettings settings = frozen(256, Store::hardware_sparse);
  const Pairs expected = other.settle(settings);
  const VkDevice device = gpu().desc().device;
  VkFence fence = VK_NULL_HANDLE;
  VkSemaphore bound = VK_NULL_HANDLE;
  const VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  const VkSemaphoreCreateInfo semaphore_info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  check(vkCreateFence(device, &fence_info, nullptr, &fence), "vkCreateFence");
  check(vkCreateSemaphore(device, &semaphore_info, nullptr, &bound), "vkCreateSemaphore");
  ShadowSystem& system = rig.system();
  for (uint32_t frame = 0; frame < 2; ++frame) {  // pages to bind, then none
    const FrameDesc desc = rig.describe(settings);
    take(system.begin_frame(desc));
    const VkCommandBuffer first = gpu().begin();
    system.record_scene(first);
    system.record_requests(first);
    gpu().submit(first, fence);
    take(system.bind_pages({.queue = gpu().queue(), .requests = fence, .bound = bound}));
    check(vkResetFences(device, 1, &fence), "vkResetFences");
    const VkCommandBuffer second = gpu().begin();
    system.record_shadows(second);
    check(vkEndCommandBuffer(second), "vkEndCommandBuffer");
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1, info.pCommandBuffers = &second;
    info.waitSemaphoreCount = 1, info.pWaitSemaphores = &bound, info.pWaitDstStageMask = &stage;
    check(vkQueueSubmit(gpu().queue(), 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
    check(vkQueueWaitIdle(gpu().queue()), "vkQueueWaitIdle");
    system.collect(desc.serial);
    EXPECT_EQ(system.statistics().pages_bound > 0, frame == 0);
    expect_bound(rig);
  }
  EXPECT_EQ(differences(expected, rig.settle(settings)), 0u);
  vkDestroySemaphore(device, bound, nullptr);
  vkDestroyFence(device, fence, nullptr);
}

TEST_F(HardwareSparse, RefusesToBindOutOfTurn) {
  PairRig pages(gpu(), {}, balls_scene(5, 3, 93));
  EXPECT_FALSE(pages.system().binds_pages());
  EXPECT_EQ(pages.system().bind_pages({.queue = gpu().queue()}).error().code, ErrorCode::invalid_argument);
  PairRig images(gpu(), sparse(), balls_scene(5, 3, 93));
  EXPECT_TRUE(images.system().binds_pages());
  EXPECT_EQ(images.system().bind_pages({.queue = gpu().queue()}).error().code, ErrorCode::invalid_argument)
      << "no frame has begun";
  images.settle();
  EXPECT_EQ(images.system().bind_pages({}).error().code, ErrorCode::invalid_argument) << "no queue";
}

TEST_F(HardwareSparse, FallsWithTheBudgetAndReturns) {
  const SeenScene scene = balls_scene(40, 30, 88);
  const FrameSettings settings{.layout = MapLayout::exact, .min_resolution = 512};
  std::map<uint32_t, Pairs> before;
  for (const uint32_t budget_mib : {256u, 16u, 4u, 256u}) {
    SCOPED_TRACE(std::to_string(budget_mib) + " MiB");
    PairRig rig(gpu(), sparse(budget_mib), scene);
    const Pairs answers = rig.settle(settings);
    EXPECT_EQ(differences(answers, rig.evaluate(settings)), 0u) << "a still picture flickers";
    EXPECT_LE(answers.statistics.shadow_memory_bytes, uint64_t(budget_mib) << 20);
    EXPECT_EQ(rig.counters().fitted, 1u);
    expect_bound(rig);
    EXPECT_EQ(rig.system().degraded_lights().empty(), budget_mib == 256);
    const auto [known, is_new] = before.try_emplace(budget_mib, answers);
    if (!is_new) { EXPECT_EQ(differences(known->second, answers), 0u); }
  }
}

TEST_F(HardwareSparse, HasAPlaceForThousandsOfLights) {
  PairRig rig(gpu(), sparse(4), balls_scene(20, 1000, 89, 32, 32));
  const FrameSettings settings{.undersampling = 4, .merge_below = 16};
  const Pairs answers = rig.settle(settings);
  EXPECT_EQ(differences(answers, rig.evaluate(settings)), 0u);
  expect_bound(rig);
}

// --- The attachment form ------------------------------------------------------------------------------------------------------

/// All of it but the images' memory, which is ordinary here: no driver of the tests has sparse depth attachments that work.
TEST_F(HardwareSparse, DrawsThePagePoolsDepthsIn16BitsWithAttachments) {
  if (!gpu().desc().enabled.vertex_layer) GTEST_SKIP() << "no shaderOutputLayer";
  const SeenScene scene = balls_scene(60, 40, 90);
  PairRig pages(gpu(), {}, scene), images(gpu(), sparse(), scene);
  const store::SparseForm form{.is_attachment = true, .page = {256, 128}, .is_sparse = false};
  images.stages().sparse = take(store::SparseImages::create(*images.state().device, *images.state().pipelines, form));
  images.stages().layer_writer =
      take(raster::LayerWriter::create(*images.state().pipelines, raster::LayerWriter::Target::depth16));
  for (const uint32_t resolution : {32u, 256u, 512u}) {
    const Pairs expected = pages.settle(frozen(resolution, Store::page_pool)),
                answers = images.settle(frozen(resolution, Store::hardware_sparse));
    expect_bound(images);
    size_t asked = 0, shadows = 0, darker = 0, other_side = 0;
    for (size_t i = 0; i < expected.visibility.size(); ++i) {
      if (expected.visibility[i] < 0) continue;
      ++asked;
      shadows += expected.visibility[i] < 0.5f;
      darker += answers.visibility[i] < expected.visibility[i] - 0.01f;
      other_side += (expected.visibility[i] < 0.5f) != (answers.visibility[i] < 0.5f);
    }
    EXPECT_GT(shadows, 500u) << resolution << " texels";
    EXPECT_LE(darker, asked / 2000) << resolution << " texels";
    EXPECT_LE(other_side, shadows / 50) << resolution << " texels";
    EXPECT_EQ(differences(answers, images.evaluate(frozen(resolution, Store::hardware_sparse))), 0u);
  }
}

// --- Refusals -------------------------------------------------------------------------------------------------------------------

void expect_refused(const DeviceDesc& desc, const StaticSettings& settings, const std::string& device,
                    const char* what) {
  const auto refused = ShadowSystem::create(desc, settings);
  ASSERT_FALSE(refused) << what;
  EXPECT_EQ(refused.error().code, ErrorCode::unsupported);
  EXPECT_NE(refused.error().message.find(what), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find(device), std::string::npos) << refused.error().message;
}

TEST_F(HardwareSparse, IsRefusedWithTheReason) {
  const std::string device = gpu().device().name();
  DeviceDesc without = gpu().desc();
  without.enabled.sparse_residency = false;
  expect_refused(without, sparse(), device, "sparseResidencyImage2D");
  StaticSettings depth16 = sparse();
  depth16.sparse_texels = SparseTexels::depth16;
  if (gpu().device().driver_id() == VK_DRIVER_ID_MESA_LLVMPIPE)
    expect_refused(gpu().desc(), depth16, device, "sparse depth attachments are broken");
  DeviceDesc no_layer = gpu().desc();
  no_layer.enabled.vertex_layer = false;
  if (gpu().device().driver_id() != VK_DRIVER_ID_MESA_LLVMPIPE)
    expect_refused(no_layer, depth16, device, "shaderOutputLayer");
}

TEST_F(HardwareSparse, TakesNoOtherStoresWriter) {
  Settings settings{.fixed = sparse()};
  EXPECT_TRUE(validate(settings));
  for (const Writer writer : {Writer::traditional, Writer::multi_draw, Writer::compute, Writer::fragments}) {
    settings.frame.writer = writer;
    EXPECT_FALSE(validate(settings)) << int(writer);
  }
}

}  // namespace
}  // namespace umbrage::test
