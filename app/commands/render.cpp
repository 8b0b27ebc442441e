// umbrage render.
#include "commands/render.hpp"

#include <filesystem>

#include "commands/image_file.hpp"
#include "commands/progress.hpp"
#include "commands/run_outputs.hpp"
#include "commands/session.hpp"

namespace app {
namespace {

using umbrage::Result;

Result<void> write_image(Session& session, Outputs& outputs, const std::string& target) {
  const auto image = session.renderer().read_image();
  if (!image) return image.error();
  const Extent& size = session.options().size;
  return write_png(outputs, target, size.width, size.height, *image);
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
  add_shared_options(command, options.shared);
  add_mirror_option(command, options.shared);
  const auto take_image = [&options](const std::string& name) {
    if (count_number_places(name) > 1)
      throw CLI::ValidationError("-o", "\"" + name + "\" has more than one place for the frame's number");
    const std::string extension = std::filesystem::path(name).extension().string();
    if (!extension.empty() && extension != ".png" && extension != ".PNG")
      throw CLI::ValidationError("-o", "\"" + name + "\": pictures are PNG files: end the name in .png");
    options.image = name;
  };
  command
      .add_option_function<std::string>("-o,--output", take_image,
                                        "The picture; %04d in the name writes every frame, otherwise the last")
      ->type_name("OUT.png")
      ->required();
}

Result<void> run_render(const RenderOptions& options, Outputs& outputs) {
  if (const auto checked = check_run_outputs(options.shared, options.image); !checked) return checked.error();
  Progress progress;
  auto session = Session::open(options.shared, progress);
  if (!session) return session.error();
  const bool is_sequence = count_number_places(options.image) == 1;
  const auto drawn = session->draw_frames(progress, [&](uint32_t frame) -> Result<void> {
    if (!is_sequence) return {};
    return write_image(*session, outputs, numbered_name(options.image, frame));
  });
  if (!drawn) return drawn.error();
  if (!is_sequence) {
    progress.show("writing " + options.image);
    if (const auto written = write_image(*session, outputs, options.image); !written) return written.error();
  }
  return write_run_outputs(*session, outputs, progress);
}

}  // namespace app
