// Colours of debug pictures, display-encoded.

/// A saturated colour per index; neighbouring indices differ clearly.
vec3 hash_color(uint index) {
  uint h = index * 0x9e3779b9u;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h ^= h >> 13;
  float hue = float(h & 0xffffu) / 65536.0;
  float strength = 0.55 + 0.35 * float(h >> 24) / 255.0;
  vec3 pure = clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
  return mix(vec3(1.0), pure, strength);
}

/// Turbo (A. Mikhailov, 2019), polynomial fit. 0 blue … 1 red.
vec3 turbo(float x) {
  const vec4 red = vec4(0.13572138, 4.61539260, -42.66032258, 132.13108234);
  const vec4 green = vec4(0.09140261, 2.19418839, 4.84296658, -14.18503333);
  const vec4 blue = vec4(0.10667330, 12.64194608, -60.58204836, 110.36276771);
  const vec2 red_tail = vec2(-152.94239396, 59.28637943);
  const vec2 green_tail = vec2(4.27729857, 2.82956604);
  const vec2 blue_tail = vec2(-89.90310912, 27.34824973);
  x = clamp(x, 0.0, 1.0);
  vec4 low = vec4(1.0, x, x * x, x * x * x);
  vec2 high = low.zw * low.z;
  return clamp(vec3(dot(low, red) + dot(high, red_tail), dot(low, green) + dot(high, green_tail),
                    dot(low, blue) + dot(high, blue_tail)), 0.0, 1.0);
}
