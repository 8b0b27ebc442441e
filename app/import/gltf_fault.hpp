// How the importer's parts refuse a file: they throw a Fault, import_gltf catches it and nothing leaves the module.
#pragma once
#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "umbrage/result.hpp"

namespace app::gltf {

struct Fault : std::runtime_error {
  Fault(umbrage::ErrorCode error_code, const std::string& text) : std::runtime_error(text), code(error_code) {}
  umbrage::ErrorCode code;
};

template <class... Parts>
[[noreturn]] void refuse_as(umbrage::ErrorCode code, const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw Fault(code, text.str());
}

/// The parts, one after the other, are the message: place, colon, fault.
template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  refuse_as(umbrage::ErrorCode::invalid_argument, parts...);
}

/// "meshes[3]", "meshes[3].primitives[0]".
inline std::string place(std::string_view list, size_t index) {
  return std::string(list) + '[' + std::to_string(index) + ']';
}

}  // namespace app::gltf
