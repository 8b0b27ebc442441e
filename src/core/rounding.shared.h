// Numbers to integers by an addition: drivers that saturate conversions do them one lane at a time.
#ifndef UMBRAGE_CORE_ROUNDING_SHARED_H
#define UMBRAGE_CORE_ROUNDING_SHARED_H
#include "core/shared_math.h"

UMB_NAMESPACE_BEGIN

/// The nearest integer, ties to even; |x| ≤ 2^22. Other values and NaN give some integer.
UMB_FN int round_to_int(float x) {
  UMB_PRECISE float shifted = x + 12582912.0f;   // 1.5 · 2^23: the lowest bit is worth 1
  return floatBitsToInt(shifted) - 0x4b400000;
}
/// The integer part of x, clamped to 0 … last; last ≤ 2^22. NaN gives some integer of these.
UMB_FN uint floor_to_uint(float x, uint last) { return min(uint(round_to_int(floor(clamp(x, 0.0f, float(last))))), last); }

UMB_NAMESPACE_END
#endif
