// Records debug pictures.
#include "host/show.hpp"

#include <algorithm>
#include <string_view>

namespace app {

using umbrage::Result;

namespace {
constexpr uint32_t show_debug[] =
#include "shaders/show_debug.comp.inc"
    ;
constexpr uint32_t show_maps[] =
#include "shaders/show_maps.comp.inc"
    ;
constexpr uint32_t show_projection[] =
#include "shaders/show_projection.comp.inc"
    ;
constexpr uint32_t show_cascades[] =
#include "shaders/show_cascades.comp.inc"
    ;
constexpr uint32_t choose_light[] =
#include "shaders/choose_light.comp.inc"
    ;
constexpr uint32_t choose_receiver[] =
#include "shaders/choose_receiver.comp.inc"
    ;
constexpr uint32_t draw_boxes_vertices[] =
#include "shaders/draw_boxes.vert.inc"
    ;
constexpr uint32_t draw_boxes_fragments[] =
#include "shaders/draw_boxes.frag.inc"
    ;
constexpr uint32_t draw_lines_vertices[] =
#include "shaders/draw_lines.vert.inc"
    ;
constexpr uint32_t draw_lines_fragments[] =
#include "shaders/draw_lines.frag.inc"
    ;
constexpr uint32_t tile = 8;
/// Lines of draw_lines.vert: box, cube, rectangles on six faces, rays, light.
constexpr uint32_t cube_line_vertices = 6 * (12 + 12 + 6 * 4 + 8 + 3);

constexpr ShowInfo show_infos[] = {
    {Show::image, "image", "the tone-mapped image"},
    {Show::clusters, "clusters", "each cluster of receivers in a colour of its own"},
    {Show::explicit_bounds, "explicit-bounds", "the image dimmed, with the clusters' boxes"},
    {Show::lights_per_pixel, "lights-per-pixel", "how many lights each pixel's cluster lists, blue to red"},
    {Show::normals, "normals", "geometric normals in world space, 0.5 n + 0.5"},
    {Show::depth, "depth", "distance, white near and black far, on a logarithmic scale"},
    {Show::resolution, "resolution", "texels along a side of the map that each pixel's light uses", ShowLight::used},
    {Show::texels_per_pixel, "texels-per-pixel", "how many pixels a shadow texel is long, blue below one and red above",
     ShowLight::used},
    {Show::pages, "pages", "the pages of the map that each pixel's light uses, coloured by its resolution",
     ShowLight::used, ShowNeeds::page_pool},
    {Show::triangles_per_map, "triangles-per-map",
     "how many triangles are drawn into the map that each pixel's light uses", ShowLight::used, ShowNeeds::page_pool},
    {Show::projection_maps, "projection-maps", "the maps of one light unfolded: tiles with receivers, and pages",
     ShowLight::used, ShowNeeds::page_pool},
    {Show::cube_projection, "cube-projection", "the box of the cluster in the middle on the virtual cube of its light",
     ShowLight::used},
    {Show::cascades, "cascades",
     "the cascades of a directional light: finished (grey), taken over (blue), newly drawn (red)", ShowLight::used,
     ShowNeeds::cascades},
};

uint32_t shader_show(Show show) {
  switch (show) {
    case Show::clusters:
      return gpu::ShowClusters;
    case Show::explicit_bounds:
      return gpu::ShowExplicitBounds;
    case Show::lights_per_pixel:
      return gpu::ShowLightsPerPixel;
    case Show::normals:
      return gpu::ShowNormals;
    case Show::depth:
      return gpu::ShowDepth;
    case Show::resolution:
      return gpu::ShowResolution;
    case Show::texels_per_pixel:
      return gpu::ShowTexelsPerPixel;
    case Show::pages:
      return gpu::ShowPages;
    case Show::triangles_per_map:
      return gpu::ShowTriangles;
    case Show::projection_maps:
      return gpu::ShowProjectionMaps;
    case Show::cube_projection:
      return gpu::ShowCubeProjection;
    case Show::cascades:
      return gpu::ShowCascades;
    case Show::image:
      break;
  }
  return 0;
}

/// What the picture says of itself; empty: nothing. Shaders add the number of a light that they choose.
std::string title_of(Show show, std::optional<uint32_t> light) {
  const std::string of_light = light ? ", light " + std::to_string(*light) : ", brightest light";
  if (show == Show::resolution) return "map resolution" + of_light;
  if (show == Show::texels_per_pixel) return "pixels along a shadow texel" + of_light;
  if (show == Show::pages) return "pages by map resolution" + of_light;
  if (show == Show::triangles_per_map) return "triangles drawn into the map" + of_light;
  if (show == Show::projection_maps) return "receiver tiles (bright: far) and pages of light";
  if (show == Show::cube_projection) return "cluster on the cube of light";
  if (show == Show::cascades) return "no directional light with cascades";
  return {};
}

gpu::ShowPush push_of(const gpu::FramePush& frame, VkDeviceAddress subject, Show show, std::optional<uint32_t> light) {
  gpu::ShowPush push{};
  push.frame = frame.frame;
  push.subject = subject;
  push.show = shader_show(show);
  push.light = light.value_or(gpu::NoLight);
  const std::string title = title_of(show, light);
  const size_t length = std::min(title.size(), sizeof(push.title) - 1);
  for (size_t i = 0; i < length; ++i) push.title[i / 4] |= uint32_t{static_cast<uint8_t>(title[i])} << 8 * (i % 4);
  return push;
}
}  // namespace

std::span<const ShowInfo> shows() { return show_infos; }

Result<ShowPass> ShowPass::create(const GpuContext& context, VkPipelineLayout layout, const Targets& targets,
                                  uint32_t max_lights) {
  ShowPass pass;
  struct Wanted {
    Handle<VkPipeline>* pipeline;
    Spirv words;
    const char* name;
  };
  const Wanted all[] = {{&pass.debug_, show_debug, "show debug"},
                        {&pass.maps_, show_maps, "show maps"},
                        {&pass.projection_, show_projection, "show projection maps"},
                        {&pass.cascades_, show_cascades, "show cascades"},
                        {&pass.choose_light_, choose_light, "choose light"},
                        {&pass.choose_receiver_, choose_receiver, "choose receiver"}};
  for (const Wanted& wanted : all) {
    auto pipeline = create_compute_pipeline(context, layout, wanted.words, wanted.name);
    if (!pipeline) return pipeline.error();
    *wanted.pipeline = std::move(pipeline).value();
  }
  if (auto made = pass.create_line_pipelines(context, layout, targets); !made) return made.error();
  auto subject = context.create_buffer(sizeof(gpu::GpuSubject) + max_lights * sizeof(gpu::GpuLightUse), Memory::device,
                                       "subject of debug pictures");
  if (!subject) return subject.error();
  pass.subject_ = std::move(subject).value();
  return pass;
}

Result<void> ShowPass::create_line_pipelines(const GpuContext& context, VkPipelineLayout layout,
                                             const Targets& targets) {
  const VkFormat format = targets[Target::picture].format();
  GraphicsPipelineDesc desc;
  desc.name = "draw boxes";
  desc.vertex = draw_boxes_vertices;
  desc.fragment = draw_boxes_fragments;
  desc.color_formats = {&format, 1};
  desc.depth = DepthUse::test;
  desc.topology = VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
  auto boxes = create_graphics_pipeline(context, layout, desc);
  if (!boxes) return boxes.error();
  boxes_ = std::move(boxes).value();
  desc.name = "draw lines";
  desc.vertex = draw_lines_vertices;
  desc.fragment = draw_lines_fragments;
  desc.blend = Blend::premultiplied;
  desc.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  auto lines = create_graphics_pipeline(context, layout, desc);
  if (!lines) return lines.error();
  lines_ = std::move(lines).value();
  return {};
}

void ShowPass::record(PassContext& pass, Show show, std::optional<uint32_t> light, VkBuffer counters) const {
  const gpu::ShowPush push = push_of(pass.push, subject_.address(), show, light);
  const uint32_t columns = groups(pass.targets.width(), tile), rows = groups(pass.targets.height(), tile);
  if (show == Show::projection_maps) {
    dispatch(pass, push, choose_light_.get(), 1, 1);
    dispatch(pass, push, projection_.get(), columns, rows);
  } else if (show == Show::cascades) {
    dispatch(pass, push, cascades_.get(), columns, rows);
  } else if (show == Show::resolution || show == Show::texels_per_pixel || show == Show::pages ||
             show == Show::triangles_per_map) {
    dispatch(pass, push, maps_.get(), columns, rows);
  } else {
    if (show == Show::cube_projection) dispatch(pass, push, choose_receiver_.get(), 1, 1);
    dispatch(pass, push, debug_.get(), columns, rows);
  }
  if (show == Show::explicit_bounds) {
    begin_lines(pass, push, boxes_.get());
    // With a count, though it is always 1: Mesa 25.0's software driver takes the count of an earlier draw where there is none.
    pass.gpu.vk.vkCmdDrawIndirectCount(pass.commands, counters, offsetof(gpu::GpuCounters, box_vertices), counters,
                                       offsetof(gpu::GpuCounters, box_draws), 1, sizeof(VkDrawIndirectCommand));
    end_lines(pass);
  }
  if (show == Show::cube_projection) {
    begin_lines(pass, push, lines_.get());
    pass.gpu.vk.vkCmdDraw(pass.commands, cube_line_vertices, 1, 0, 0);
    end_lines(pass);
  }
}

void ShowPass::dispatch(const PassContext& pass, const gpu::ShowPush& push, VkPipeline pipeline, uint32_t x,
                        uint32_t y) const {
  pass.gpu.vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  push_constants(pass.gpu, pass.commands, pass.layout, push);
  pass.gpu.vk.vkCmdDispatch(pass.commands, x, y, 1);
  memory_barrier(pass.gpu, pass.commands, compute_write, compute_access);
}

/// What a compute shader wrote is drawn over the picture.
void ShowPass::begin_lines(const PassContext& pass, const gpu::ShowPush& push, VkPipeline pipeline) const {
  Targets& targets = pass.targets;
  const VolkDeviceTable& vk = pass.gpu.vk;
  memory_barrier(pass.gpu, pass.commands, compute_write,
                 {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
                  VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
  begin_drawing_over(pass.gpu, pass.commands, targets, Target::picture);
  push_constants(pass.gpu, pass.commands, pass.layout, push);
  vk.vkCmdBindPipeline(pass.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
}

void ShowPass::end_lines(const PassContext& pass) const {
  pass.gpu.vk.vkCmdEndRendering(pass.commands);
  pass.targets[Target::picture].use(pass.gpu, pass.commands, ImageUse::storage);
}

}  // namespace app
