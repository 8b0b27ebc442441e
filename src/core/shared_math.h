// Lets one source be C++ and GLSL: a `*.shared.h` includes this first and writes its functions and structs with the
// macros below. C++ gets namespace umbrage::shared on glm types, GLSL gets plain functions. Structs are laid out
// scalar, buffer addresses are uint64_t, there are no swizzles, and vectors are built by explicit constructors.
#ifndef UMBRAGE_CORE_SHARED_MATH_H
#define UMBRAGE_CORE_SHARED_MATH_H

#ifdef __cplusplus

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>

#define UMB_NAMESPACE_BEGIN namespace umbrage::shared {
#define UMB_NAMESPACE_END }
#define UMB_FN inline
#define UMB_CONST inline constexpr
#define UMB_PRECISE
#define UMB_OUT(T) T&
#define UMB_INOUT(T) T&
#define UMB_ASSERT_SIZE(T, n) static_assert(sizeof(T) == (n), #T " must have the size it has in GLSL's scalar layout")

namespace umbrage::shared {

using glm::ivec2, glm::ivec3, glm::ivec4, glm::uvec2, glm::uvec3, glm::uvec4;
using glm::mat3, glm::mat4, glm::uint, glm::vec2, glm::vec3, glm::vec4;

using glm::abs, glm::acos, glm::asin, glm::atan, glm::ceil, glm::clamp, glm::cos, glm::cross, glm::distance, glm::dot;
using glm::all, glm::any, glm::equal, glm::greaterThan, glm::greaterThanEqual, glm::lessThan, glm::lessThanEqual;
using glm::exp, glm::exp2, glm::floor, glm::fract, glm::inversesqrt, glm::isinf, glm::isnan, glm::length, glm::log;
using glm::log2, glm::max, glm::min, glm::mix, glm::mod, glm::normalize, glm::pow, glm::round, glm::roundEven,
    glm::sign, glm::sin;
using glm::smoothstep, glm::sqrt, glm::step, glm::tan, glm::transpose, glm::trunc;

inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }
inline int floatBitsToInt(float value) { return std::bit_cast<int>(value); }
inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }
inline int bitCount(uint value) { return std::popcount(value); }
/// As in GLSL: -1 for 0.
inline int findLSB(uint value) { return value == 0u ? -1 : std::countr_zero(value); }
inline int findMSB(uint value) { return 31 - std::countl_zero(value); }

}  // namespace umbrage::shared

#else

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#define UMB_NAMESPACE_BEGIN
#define UMB_NAMESPACE_END
#define UMB_FN
#define UMB_CONST const
#define UMB_PRECISE precise
#define UMB_OUT(T) out T
#define UMB_INOUT(T) inout T
#define UMB_ASSERT_SIZE(T, n)

#endif
#endif
