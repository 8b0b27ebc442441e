// Numbers that look random and are the same on every machine: an integer hash over a counter.
#pragma once
#include <cstdint>

namespace app {

/// A bijective mix of 32 bits (Wellons' lowbias32).
constexpr uint32_t mix_bits(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

constexpr uint32_t mix_bits(uint32_t a, uint32_t b) { return mix_bits(a ^ (mix_bits(b) + 0x9e3779b9u)); }

/// [0, 1), 24 bits.
constexpr float unit_float(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

class Random {
 public:
  explicit constexpr Random(uint32_t seed) : state_(mix_bits(seed ^ 0x51ed270bu)) {}
  constexpr uint32_t bits() { return mix_bits(state_ += 0x9e3779b9u); }
  constexpr float unit() { return unit_float(bits()); }
  constexpr float range(float low, float high) { return low + (high - low) * unit(); }
  /// ± spread around zero.
  constexpr float around(float spread) { return range(-spread, spread); }
  constexpr bool chance(float probability) { return unit() < probability; }
  /// 0 … count-1; count ≥ 1.
  constexpr uint32_t index(uint32_t count) { return bits() % count; }

 private:
  uint32_t state_;
};

}  // namespace app
