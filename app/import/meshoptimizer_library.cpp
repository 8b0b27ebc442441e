#include "import/meshoptimizer_library.hpp"

#include <dlfcn.h>
#include <meshoptimizer.h>

#include <cstdio>
#include <optional>
#include <type_traits>

namespace app {
namespace {

// The header's functions have the types that are called here.
using Library = MeshoptimizerLibrary;
static_assert(
    std::is_same_v<decltype(static_cast<decltype(Library::generate_vertex_remap)>(&meshopt_generateVertexRemap)),
                   decltype(Library::generate_vertex_remap)>);
static_assert(
    std::is_same_v<decltype(static_cast<decltype(Library::simplify)>(&meshopt_simplify)), decltype(Library::simplify)>);
static_assert(std::is_same_v<decltype(static_cast<decltype(Library::simplify_scale)>(&meshopt_simplifyScale)),
                             decltype(Library::simplify_scale)>);

template <typename Function>
bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

std::optional<Library> load() {
  // By its name alone: the program's RPATH has lib/ beside it.
  void* library = dlopen(UMBRAGE_MESHOPTIMIZER, RTLD_NOW | RTLD_LOCAL);
  Library made{};
  if (library && find(library, "meshopt_generateVertexRemap", made.generate_vertex_remap) &&
      find(library, "meshopt_simplify", made.simplify) && find(library, "meshopt_simplifyScale", made.simplify_scale))
    return made;
  const char* reason = dlerror();
  std::fprintf(stderr,
               "umbrage: warning: casters keep all of their triangles: %s; install libmeshoptimizer, or carry lib/ "
               "along with the program\n",
               reason ? reason : UMBRAGE_MESHOPTIMIZER " lacks what is needed");
  return {};
}

}  // namespace

const MeshoptimizerLibrary* meshoptimizer_library() {
  static const std::optional<Library> library = load();
  return library ? &*library : nullptr;
}

}  // namespace app
