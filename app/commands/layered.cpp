// umbrage layered.
#include "commands/layered.hpp"

#include <algorithm>

#include "commands/image_file.hpp"
#include "commands/json_file.hpp"
#include "commands/progress.hpp"
#include "commands/session.hpp"
#include "commands/surfaces.hpp"
#include "host/layered_geometry.hpp"
#include "layered/layered_cases.hpp"
#include "layered/layered_recommendation.hpp"
#include "layered/use_picture.hpp"

namespace app {

using umbrage::Result;

namespace {

std::vector<std::string> use_names() {
  std::vector<std::string> names;
  for (const LayeredUseInfo& info : layered_uses()) names.emplace_back(info.name);
  return names;
}

std::vector<std::string> writer_names() {
  std::vector<std::string> names;
  for (const umbrage::LayeredWriter writer : kLayeredWriters)
    if (writer != umbrage::LayeredWriter::atlas)
      names.emplace_back(umbrage::name_of(writer));  // its layout is not a use's
  return names;
}

std::string use_summary() {
  std::string text;
  for (const LayeredUseInfo& info : layered_uses())
    text += std::string(text.empty() ? "" : "; ") + info.name + ": " + info.summary;
  return text;
}

Result<umbrage::LayeredWriter> choose_writer(const LayeredOptions& options, const LayeredUseInfo& info) {
  std::string name = options.writer;
  if (!options.recommended.empty()) {
    const auto document = read_json(options.recommended);
    if (!document) return document.error();
    auto found = recommended_writer(*document, options.recommended.string(), info.has_color);
    if (!found) return found.error();
    name = *found;
  }
  for (const umbrage::LayeredWriter writer : kLayeredWriters)
    if (umbrage::name_of(writer) == name) return writer;
  return umbrage::LayeredWriter::traditional;  // what every device has
}

/// Of what is drawn.
Box solid_bounds(const Scene& scene, const Pose& posed) {
  Box box;
  for_each_primitive(scene, posed, [&](const PosedPrimitive& visited) {
    if (!is_solid(scene.materials[visited.primitive->material])) return;
    for (const glm::vec3& position : visited.positions) box.extend(position);
  });
  return box;
}

/// The surface straight below a point, or the scene's lowest.
float ground_below(const Scene& scene, const Pose& posed, const Box& bounds, const glm::vec3& eye) {
  float ground = bounds.min.y;
  for_each_primitive(scene, posed, [&](const PosedPrimitive& visited) {
    const std::vector<uint32_t>& indices = visited.primitive->indices;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
      const glm::vec3 a = visited.positions[indices[i]], b = visited.positions[indices[i + 1]],
                      c = visited.positions[indices[i + 2]];
      // Barycentric coordinates of the eye in the triangle's shadow on the ground.
      const float area = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
      if (area == 0) continue;
      const float v = ((eye.x - a.x) * (c.z - a.z) - (eye.z - a.z) * (c.x - a.x)) / area;
      const float w = ((b.x - a.x) * (eye.z - a.z) - (b.z - a.z) * (eye.x - a.x)) / area;
      if (v < 0 || w < 0 || v + w > 1) continue;
      const float height = a.y + v * (b.y - a.y) + w * (c.y - a.y);
      if (height < eye.y) ground = std::max(ground, height);
    }
  });
  return ground;
}

UseScene use_scene(const ViewCamera& camera, const Box& bounds, const Extent& size) {
  UseScene view{.view_from_world = glm::inverse(camera.world_from_camera),
                .fov_y = camera.lens.fov_y,
                .aspect = static_cast<float>(size.width) / static_cast<float>(size.height),
                .lowest = bounds.min,
                .highest = bounds.max};
  const float diagonal = std::max(bounds.diagonal(), 1e-3f);
  view.near = std::max(camera.lens.near, 1e-3f * diagonal);
  // No farther than the scene: cascades and maps are not spent on nothing.
  view.far = std::min(camera.lens.far,
                      glm::distance(glm::vec3(camera.world_from_camera[3]), bounds.center()) + 0.5f * diagonal);
  view.far = std::max(view.far, 2 * view.near);
  return view;
}

}  // namespace

void add_layered_options(CLI::App& command, LayeredOptions& options) {
  command.add_option("USE", options.use, use_summary())->required()->check(CLI::IsMember(use_names()));
  command.add_option("SCENE", options.scene, "A .gltf or .glb file, or builtin:NAME")->required();
  command.add_option("-o,--output", options.image, "The picture: every view of the use")
      ->type_name("OUT.png")
      ->required();
  auto* writer = command
                     .add_option("--writer", options.writer,
                                 "How the views are drawn; traditional. Colour needs another than compute")
                     ->type_name("NAME")
                     ->check(CLI::IsMember(writer_names()));
  command.add_option("--recommended", options.recommended, "The writer that umbrage info --recommend has found")
      ->type_name("FILE.json")
      ->excludes(writer);
  command
      .add_option_function<std::string>(
          "--size",
          [&](const std::string& text) {
            const auto size = parse_size(text);
            if (!size) throw CLI::ValidationError("--size", size.error().message);
            options.size = *size;
          },
          "Pixels of one view; 480x320. Cube faces are squares of the height")
      ->type_name("WxH");
  command
      .add_option("--camera", options.camera.name_or_index,
                  "One of the scene's cameras; else the first, else one that frames the scene")
      ->type_name("NAME-OR-INDEX");
  command.add_option("--time", options.time_s, "Animation time, seconds; 0")->type_name("S");
  command.add_option("--device", options.device, "Which GPU: an index of umbrage info, or part of a name")
      ->type_name("NAME-OR-INDEX");
  command.add_flag_callback(
      "--validate", [&] { options.validate = true; }, "With Vulkan's validation layers; any message is an error");
}

Result<void> run_layered(const LayeredOptions& options, Outputs& outputs) {
  if (const auto checked = check_target(options.image); !checked) return checked;
  const auto uses = layered_uses();
  const LayeredUseInfo& info =
      *std::find_if(uses.begin(), uses.end(), [&](const LayeredUseInfo& i) { return options.use == i.name; });
  const auto writer = choose_writer(options, info);
  if (!writer) return writer.error();
  if (info.has_color && *writer == umbrage::LayeredWriter::compute)
    return invalid("--writer: compute draws depth alone; " + options.use + " has colour: choose another");
  Progress progress;
  progress.show("reading " + options.scene);
  const auto scene = load_scene(options.scene);
  if (!scene) return scene.error();
  const Pose posed = pose(*scene, options.time_s);
  const Box bounds = solid_bounds(*scene, posed);
  if (bounds.is_empty()) return invalid(options.scene + ": there is nothing to draw");
  const float aspect = static_cast<float>(options.size.width) / static_cast<float>(options.size.height);
  const auto camera = CameraSource::create(options.camera, posed, bounds, aspect);
  if (!camera) return camera.error();
  progress.show("drawing " + options.use);
  const ViewCamera shown_camera = camera->at(posed, options.time_s);
  UseScene view = use_scene(shown_camera, bounds, options.size);
  // A hair above the ground, so that the ground itself is cut away.
  view.mirror_height =
      ground_below(*scene, posed, bounds, glm::vec3(shown_camera.world_from_camera[3])) + 1e-3f * bounds.diagonal();
  const auto picture = draw_use(*scene, posed, view,
                                {.use = info.use,
                                 .writer = *writer,
                                 .width = options.size.width,
                                 .height = options.size.height,
                                 .device = options.device,
                                 .validate = options.validate});
  if (!picture) return picture.error();
  progress.show("writing " + options.image.string());
  return write_png(outputs, options.image, picture->width, picture->height, picture->rgba);
}

}  // namespace app
