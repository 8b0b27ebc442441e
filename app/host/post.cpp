// Records exposure and tone mapping.
#include "host/post.hpp"

namespace app {

using umbrage::Result;

namespace {
constexpr uint32_t count_luminance[] =
#include "shaders/count_luminance.comp.inc"
    ;
constexpr uint32_t choose_exposure[] =
#include "shaders/choose_exposure.comp.inc"
    ;
constexpr uint32_t tone_map[] =
#include "shaders/tone_map.comp.inc"
    ;
constexpr uint32_t luminance_tile = 32;
constexpr uint32_t tile = 8;

void dispatch(const PassContext& pass, VkPipeline pipeline, uint32_t x, uint32_t y) {
  pass.gpu.vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  push_constants(pass.gpu, pass.commands, pass.layout, pass.push);
  pass.gpu.vk.vkCmdDispatch(pass.commands, x, y, 1);
  memory_barrier(pass.gpu, pass.commands, compute_write, compute_access);
}
}  // namespace

Result<PostPass> PostPass::create(const GpuContext& context, VkPipelineLayout layout) {
  PostPass pass;
  struct Wanted {
    Handle<VkPipeline>* pipeline;
    Spirv words;
    const char* name;
  };
  const Wanted all[] = {{&pass.count_luminance_, count_luminance, "count luminance"},
                        {&pass.choose_exposure_, choose_exposure, "choose exposure"},
                        {&pass.tone_map_, tone_map, "tone map"}};
  for (const Wanted& wanted : all) {
    auto pipeline = create_compute_pipeline(context, layout, wanted.words, wanted.name);
    if (!pipeline) return pipeline.error();
    *wanted.pipeline = std::move(pipeline).value();
  }
  return pass;
}

void PostPass::record_exposure(PassContext& pass) const {
  dispatch(pass, count_luminance_.get(), groups(pass.targets.width(), luminance_tile),
           groups(pass.targets.height(), luminance_tile));
  dispatch(pass, choose_exposure_.get(), 1, 1);
}

void PostPass::record_tone_map(PassContext& pass) const {
  pass.targets[Target::picture].use(pass.gpu, pass.commands, ImageUse::storage);
  dispatch(pass, tone_map_.get(), groups(pass.targets.width(), tile), groups(pass.targets.height(), tile));
}

}  // namespace app
