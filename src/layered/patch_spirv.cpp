// SPIR-V is a header of five words and then instructions: the low half of the first word is the opcode, the high half the length.
#include "layered/patch_spirv.hpp"

#include <cassert>

namespace umbrage::layered {

std::vector<uint32_t> with_execution_mode(std::span<const uint32_t> spirv, uint32_t mode, uint32_t literal) {
  constexpr uint32_t kOpExecutionMode = 16;
  std::vector<uint32_t> words(spirv.begin(), spirv.end());
  bool found = false;
  for (size_t at = 5; at < words.size();) {
    const uint32_t length = words[at] >> 16;
    assert(length > 0);
    if ((words[at] & 0xffffu) == kOpExecutionMode && length == 4 && words[at + 2] == mode) {
      words[at + 3] = literal;
      found = true;
    }
    at += length;
  }
  assert(found);
  static_cast<void>(found);
  return words;
}

}  // namespace umbrage::layered
