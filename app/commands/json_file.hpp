// JSON input from people: bounded in size and depth, duplicate keys refused, every complaint names its place.
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "umbrage/result.hpp"

namespace app {

inline constexpr uint64_t kMaxJsonBytes = 64ull << 20;

/// Whole file as text; larger ones are refused.
umbrage::Result<std::string> read_text_file(const std::filesystem::path& path, uint64_t max_bytes);

/// Errors start with the path.
umbrage::Result<nlohmann::json> read_json(const std::filesystem::path& path);

/// A value inside a file together with its place ("lights.json: lights[3].range"). Valid while the document lives.
class JsonPlace {
 public:
  JsonPlace(const nlohmann::json& value, std::string file) : value_(&value), file_(std::move(file)) {}

  const nlohmann::json& value() const { return *value_; }
  /// "file: a.b[2] complaint".
  umbrage::Error error(const std::string& complaint) const;

  /// Errors: not an object; a key that is not listed.
  umbrage::Result<void> expect_object(std::initializer_list<std::string_view> keys) const;
  umbrage::Result<void> expect_array() const;
  /// Precondition: an object.
  std::optional<JsonPlace> member(std::string_view key) const;
  /// Precondition: an array longer than index.
  JsonPlace element(size_t index) const;

  /// A finite number that is also finite as a float.
  umbrage::Result<double> number() const;
  umbrage::Result<glm::vec3> vec3() const;
  umbrage::Result<std::string> text() const;

 private:
  JsonPlace(const nlohmann::json& value, std::string file, std::string path)
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  const nlohmann::json* value_;
  std::string file_, path_;
};

/// The float as the shortest decimal that reads back as the same float, for files that people read.
double shortest_decimal(float value);

}  // namespace app
