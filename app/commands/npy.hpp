// NumPy's .npy format, version 1.0: a header, then the array in C order, little-endian. Written piece by piece.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "commands/output.hpp"
#include "umbrage/result.hpp"

namespace app {

enum class NpyType : uint8_t { float32, uint8 };

/// Magic, version, length and dictionary, padded so that the data starts at a multiple of 64 bytes.
std::string npy_header(NpyType type, std::span<const uint64_t> shape);

class NpyWriter {
 public:
  static umbrage::Result<NpyWriter> create(Outputs& outputs, const std::filesystem::path& target, NpyType type,
                                           std::span<const uint64_t> shape);
  /// The next elements in C order; T is the array's type.
  umbrage::Result<void> append(std::span<const float> values);
  umbrage::Result<void> append(std::span<const uint8_t> values);
  /// Precondition: exactly the shape's number of elements has been appended.
  umbrage::Result<void> commit();

 private:
  NpyWriter(OutputFile file, NpyType type, uint64_t remaining)
      : file_(std::move(file)), type_(type), remaining_(remaining) {}
  umbrage::Result<void> append_bytes(std::span<const std::byte> bytes, uint64_t count);

  OutputFile file_;
  NpyType type_;
  uint64_t remaining_;  // Elements still to come.
};

}  // namespace app
