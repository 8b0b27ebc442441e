// JSON input from people.
#include "commands/json_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "commands/parse.hpp"

namespace app {
namespace {

constexpr int kMaxDepth = 32;

/// Watches the parser for what it would let pass.
class ParseGuard {
 public:
  bool operator()(int depth, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (depth > kMaxDepth) throw std::length_error("nested deeper than " + std::to_string(kMaxDepth) + " levels");
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event == Event::key) {
      const auto& name = parsed.get_ref<const std::string&>();
      if (!keys_.back().insert(name).second) throw std::invalid_argument("the key \"" + name + "\" occurs twice");
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> keys_;  // Of each open object.
};

std::string without_library_prefix(std::string text) {
  if (text.starts_with("[json.exception")) text.erase(0, std::min(text.find("] ") + 2, text.size()));
  return text;
}

}  // namespace

umbrage::Result<std::string> read_text_file(const std::filesystem::path& path, uint64_t max_bytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return invalid(path.string() + ": is a folder, not a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return invalid(path.string() + ": cannot be opened: " + std::strerror(errno));
  std::string text;
  char block[1 << 16];
  while (const size_t count = std::fread(block, 1, sizeof block, file.get())) {
    text.append(block, count);
    if (text.size() > max_bytes)
      return invalid(path.string() + ": is larger than " + std::to_string(max_bytes >> 20) + " MiB");
  }
  if (std::ferror(file.get())) return invalid(path.string() + ": cannot be read: " + std::strerror(errno));
  return text;
}

umbrage::Result<nlohmann::json> read_json(const std::filesystem::path& path) {
  const auto text = read_text_file(path, kMaxJsonBytes);
  if (!text) return text.error();
  try {
    ParseGuard guard;
    return nlohmann::json::parse(*text, std::ref(guard));
  } catch (const std::exception& failure) {
    return invalid(path.string() + ": not usable JSON: " + without_library_prefix(failure.what()));
  }
}

umbrage::Error JsonPlace::error(const std::string& complaint) const {
  return invalid(file_ + ": " + (path_.empty() ? "the document" : path_) + " " + complaint);
}

umbrage::Result<void> JsonPlace::expect_object(std::initializer_list<std::string_view> keys) const {
  if (!value_->is_object()) return error(std::string("must be an object, is ") + value_->type_name());
  for (const auto& item : value_->items()) {
    if (std::find(keys.begin(), keys.end(), item.key()) != keys.end()) continue;
    const std::vector<std::string> known(keys.begin(), keys.end());
    return error("has the unknown key \"" + item.key() + "\"; known are " + join_names(known));
  }
  return {};
}

umbrage::Result<void> JsonPlace::expect_array() const {
  if (!value_->is_array()) return error(std::string("must be an array, is ") + value_->type_name());
  return {};
}

std::optional<JsonPlace> JsonPlace::member(std::string_view key) const {
  const auto found = value_->find(std::string(key));
  if (found == value_->end()) return std::nullopt;
  return JsonPlace(*found, file_, (path_.empty() ? "" : path_ + ".") + std::string(key));
}

JsonPlace JsonPlace::element(size_t index) const {
  return JsonPlace((*value_)[index], file_, path_ + "[" + std::to_string(index) + "]");
}

umbrage::Result<double> JsonPlace::number() const {
  if (!value_->is_number()) return error(std::string("must be a number, is ") + value_->type_name());
  const double number = value_->get<double>();
  if (!(std::abs(number) <= std::numeric_limits<float>::max())) return error("must be finite in single precision");
  return number;
}

umbrage::Result<glm::vec3> JsonPlace::vec3() const {
  if (!value_->is_array() || value_->size() != 3) return error("must be an array of three numbers");
  glm::vec3 result(0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto component = element(static_cast<size_t>(axis)).number();
    if (!component) return component.error();
    result[axis] = static_cast<float>(*component);
  }
  return result;
}

umbrage::Result<std::string> JsonPlace::text() const {
  if (!value_->is_string()) return error(std::string("must be a string, is ") + value_->type_name());
  return value_->get<std::string>();
}

double shortest_decimal(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double decimal = value;
  std::from_chars(text, end, decimal);
  return static_cast<float>(decimal) == value ? decimal : value;
}

}  // namespace app
