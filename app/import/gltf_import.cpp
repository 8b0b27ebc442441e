// The steps from a file to a scene. Each part checks what it reads; faults of all of them end here.
#include "import/gltf_import.hpp"

#include <exception>
#include <new>
#include <system_error>

#include "import/gltf_accessors.hpp"
#include "import/gltf_animations.hpp"
#include "import/gltf_document.hpp"
#include "import/gltf_fault.hpp"
#include "import/gltf_images.hpp"
#include "import/gltf_library.hpp"
#include "import/gltf_materials.hpp"
#include "import/gltf_meshes.hpp"
#include "import/gltf_nodes.hpp"

namespace app {
namespace {

Scene import_scene(const std::filesystem::path& file) {
  const gltf::Document document = gltf::read_document(file);
  const gltf::Model model = gltf::parse_model(document);
  gltf::Accessors accessors(document, model);
  gltf::Images images(document, model, accessors);

  Scene scene;
  gltf::Materials materials = gltf::import_materials(model, images);
  scene.materials = std::move(materials.materials);
  scene.images = images.take();
  scene.meshes = gltf::import_meshes(model, accessors, materials.uv_sets);
  scene.cameras = gltf::import_cameras(model);
  scene.lights = gltf::import_lights(model);
  const gltf::NodeMap nodes = gltf::import_nodes(model, accessors, scene);
  scene.animations = gltf::import_animations(model, accessors, nodes, scene);
  if (scene.name.empty()) scene.name = file.stem().string();
  return scene;
}

}  // namespace

umbrage::Result<Scene> import_gltf(const std::filesystem::path& file) {
  using umbrage::Error;
  using umbrage::ErrorCode;
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown) && !unknown)
    return Error{ErrorCode::invalid_argument, "there is no file " + file.string()};
  const std::string name = file.filename().string() + ": ";
  try {
    return import_scene(file);
  } catch (const gltf::Fault& fault) { return Error{fault.code, name + fault.what()}; } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory, name + "not enough memory for it"};
  } catch (const std::exception& fault) { return Error{ErrorCode::invalid_argument, name + fault.what()}; }
}

}  // namespace app
