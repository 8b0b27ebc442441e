// The G-buffer's record of a surface besides depth and geometric normal: four words, so that one target holds it.

struct PackedSurface {
  vec3 normal;              // World, unit length.
  vec3 base_color;          // Linear, 0 … 1.
  float metallic, roughness;
  vec3 emissive;            // What shines whatever the lights do; of unlit surfaces all.
  bool unlit;
};

/// x in 0 … 1 as 0 … last, to the nearest; last < 2^16. An addition instead of a conversion, see core/rounding.shared.h.
uint pack_unit(float x, uint last) { return floatBitsToUint(x * float(last) + 8388608.0) & last; }

/// As packSnorm2x16.
uint pack_signs(vec2 v) {
  uvec2 shifted = floatBitsToUint(v * 32767.0 + 12582912.0);
  return shifted.x & 0xffffu | shifted.y << 16;
}

/// Nine bits a channel below one power of two, as E5B9G9R9. 0 ≤ c ≤ 65000.
uint pack_radiance(vec3 c) {
  int exponent = (floatBitsToInt(max(max(c.r, c.g), max(c.b, 1.6e-5))) >> 23) - 127;
  vec3 scaled = c * intBitsToFloat((127 + 8 - exponent) << 23);
  uvec3 mantissa = floatBitsToUint(min(scaled, vec3(511.0)) + 8388608.0) & 511u;
  return mantissa.r | mantissa.g << 9 | mantissa.b << 18 | uint(exponent + 16) << 27;
}

vec3 unpack_radiance(uint word) {
  float unit = uintBitsToFloat((127u - 8u - 16u + (word >> 27)) << 23);
  return vec3(word & 511u, word >> 9 & 511u, word >> 18 & 511u) * unit;
}

uvec4 pack_surface(PackedSurface s) {
  // Square roots spend ten bits about as eyes do, finer than sRGB's eight everywhere.
  vec3 root = sqrt(clamp(s.base_color, 0.0, 1.0));
  uint color = pack_unit(root.r, 1023u) | pack_unit(root.g, 1023u) << 10 | pack_unit(root.b, 1023u) << 20;
  return uvec4(pack_signs(octahedral(s.normal)), color | (s.unlit ? 1u << 31 : 0u),
               pack_unit(s.metallic, 65535u) | pack_unit(s.roughness, 65535u) << 16, pack_radiance(s.emissive));
}

vec3 unpack_normal(uvec4 words) { return from_octahedral(unpackSnorm2x16(words.x)); }

PackedSurface unpack_surface(uvec4 words) {
  PackedSurface s;
  s.normal = unpack_normal(words);
  vec3 root = vec3(words.y & 1023u, words.y >> 10 & 1023u, words.y >> 20 & 1023u) / 1023.0;
  s.base_color = root * root;
  s.metallic = float(words.z & 65535u) / 65535.0;
  s.roughness = float(words.z >> 16) / 65535.0;
  s.emissive = unpack_radiance(words.w);
  s.unlit = words.y >> 31 != 0u;
  return s;
}
