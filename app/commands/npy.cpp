// NumPy's .npy format.
#include "commands/npy.hpp"

#include <bit>
#include <cassert>

namespace app {

static_assert(std::endian::native == std::endian::little, "the arrays are written as they lie in memory");

std::string npy_header(NpyType type, std::span<const uint64_t> shape) {
  std::string dimensions;
  for (const uint64_t extent : shape) dimensions += std::to_string(extent) + ", ";
  if (shape.size() > 1)
    dimensions.resize(dimensions.size() - 2);  // Python needs the comma of a one-element tuple only.
  const char* descr = type == NpyType::float32 ? "<f4" : "|u1";
  std::string dictionary =
      std::string("{'descr': '") + descr + "', 'fortran_order': False, 'shape': (" + dimensions + "), }";
  constexpr size_t kPrefix = 10;  // Magic, version and length.
  dictionary.append(63 - (kPrefix + dictionary.size()) % 64, ' ');
  dictionary += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(dictionary.size() & 0xff);
  header += static_cast<char>(dictionary.size() >> 8);
  return header + dictionary;
}

umbrage::Result<NpyWriter> NpyWriter::create(Outputs& outputs, const std::filesystem::path& target, NpyType type,
                                             std::span<const uint64_t> shape) {
  auto file = outputs.open(target);
  if (!file) return file.error();
  if (const auto written = file->write(npy_header(type, shape)); !written) return written.error();
  uint64_t count = 1;
  for (const uint64_t extent : shape) count *= extent;
  return NpyWriter(std::move(*file), type, count);
}

umbrage::Result<void> NpyWriter::append(std::span<const float> values) {
  assert(type_ == NpyType::float32);
  return append_bytes(std::as_bytes(values), values.size());
}

umbrage::Result<void> NpyWriter::append(std::span<const uint8_t> values) {
  assert(type_ == NpyType::uint8);
  return append_bytes(std::as_bytes(values), values.size());
}

umbrage::Result<void> NpyWriter::append_bytes(std::span<const std::byte> bytes, uint64_t count) {
  assert(count <= remaining_);
  remaining_ -= count;
  return file_.write(bytes);
}

umbrage::Result<void> NpyWriter::commit() {
  assert(remaining_ == 0);
  return file_.commit();
}

}  // namespace app
