// Hashes of prepared bytes and of what they are made from.
#include "scene/prepare_format.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace umbrage::scene {

// MurmurHash64A (Austin Appleby, public domain) over one span after the other.
uint64_t hash_bytes(uint64_t hash, std::span<const std::byte> bytes) {
  constexpr uint64_t Multiplier = 0xc6a4a7935bd1e995u;
  hash ^= bytes.size() * Multiplier;
  for (size_t at = 0; at < bytes.size(); at += sizeof(uint64_t)) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof(word), bytes.size() - at));
    word *= Multiplier;
    word ^= word >> 47;
    hash = (hash ^ word * Multiplier) * Multiplier;
  }
  hash = (hash ^ hash >> 47) * Multiplier;
  return hash ^ hash >> 47;
}

uint64_t checksum(std::span<const std::byte> bytes) {
  assert(bytes.size() >= sizeof(PreparedHeader));
  PreparedHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  header.checksum = 0;
  const uint64_t hash = hash_bytes(0, std::as_bytes(std::span(&header, 1)));
  return hash_bytes(hash, bytes.subspan(sizeof(header)));
}

}  // namespace umbrage::scene
