// Value noise and cell noise, evaluated per texel; a surface's normals come from differences of its own height field.
#include "scenes/textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "scenes/random.hpp"

namespace app {
namespace {

using glm::vec2;
using glm::vec3;

float smooth(float t) { return t * t * (3 - 2 * t); }
float ramp(float low, float high, float x) { return smooth(std::clamp((x - low) / (high - low), 0.0f, 1.0f)); }

float lattice(uint32_t x, uint32_t y, uint32_t seed) { return unit_float(mix_bits(x + y * 7919u, seed)); }

/// Value noise over the unit square with `cells` lattice points a side, tileable.
float noise(vec2 uv, uint32_t cells_x, uint32_t cells_y, uint32_t seed) {
  const float x = uv.x * static_cast<float>(cells_x), y = uv.y * static_cast<float>(cells_y);
  const float fx = std::floor(x), fy = std::floor(y);
  const uint32_t x0 = static_cast<uint32_t>(fx) % cells_x, y0 = static_cast<uint32_t>(fy) % cells_y;
  const uint32_t x1 = (x0 + 1) % cells_x, y1 = (y0 + 1) % cells_y;
  const float tx = smooth(x - fx), ty = smooth(y - fy);
  return std::lerp(std::lerp(lattice(x0, y0, seed), lattice(x1, y0, seed), tx),
                   std::lerp(lattice(x0, y1, seed), lattice(x1, y1, seed), tx), ty);
}

float fractal(vec2 uv, uint32_t cells, int octaves, uint32_t seed) {
  float sum = 0, weight = 0.5f, total = 0;
  for (int i = 0; i < octaves; ++i, cells *= 2, weight *= 0.5f) {
    sum += weight * noise(uv, cells, cells, seed + static_cast<uint32_t>(i));
    total += weight;
  }
  return sum / total;
}

struct Cell {
  float edge;   ///< Distance to the border of the nearest stone over the cell size: 0 in the joint.
  uint32_t id;  ///< Differs from stone to stone.
};

/// Stones laid in rows, every other row shifted; widths vary.
Cell brickwork(vec2 uv, uint32_t columns, uint32_t rows, uint32_t seed) {
  const float y = uv.y * static_cast<float>(rows);
  const uint32_t row = static_cast<uint32_t>(y) % rows;
  float x = uv.x * static_cast<float>(columns) + lattice(row, 3, seed);
  const float column = std::floor(x);
  const auto border = [&](float c) {
    const uint32_t wrapped = static_cast<uint32_t>(c + static_cast<float>(columns)) % columns;
    return c + 0.5f * (lattice(wrapped, row, seed + 1) - 0.5f);
  };
  float low = border(column), high = border(column + 1);
  uint32_t index = static_cast<uint32_t>(column + static_cast<float>(columns));
  if (x < low)
    high = std::exchange(low, border(column - 1)), --index;
  else if (x > high)
    low = std::exchange(high, border(column + 2)), ++index;
  const float aspect = static_cast<float>(rows) / static_cast<float>(columns);
  const float in_row = y - std::floor(y);
  const float edge = std::min({(x - low) * aspect, (high - x) * aspect, in_row, 1 - in_row});
  return {edge, mix_bits(index % columns, row + seed * 131u)};
}

/// Voronoi cells of a jittered lattice.
Cell pebbles(vec2 uv, uint32_t cells, uint32_t seed) {
  const vec2 p = uv * static_cast<float>(cells);
  const int cx = static_cast<int>(p.x), cy = static_cast<int>(p.y);
  float nearest = 9, second = 9;
  uint32_t id = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const uint32_t x = static_cast<uint32_t>(cx + dx + static_cast<int>(cells)) % cells;
      const uint32_t y = static_cast<uint32_t>(cy + dy + static_cast<int>(cells)) % cells;
      const vec2 centre =
          vec2(cx + dx, cy + dy) + 0.5f + 0.55f * (vec2(lattice(x, y, seed), lattice(x, y, seed + 1)) - 0.5f);
      const float d = glm::distance(p, centre);
      if (d < nearest)
        second = std::exchange(nearest, d), id = mix_bits(x, y + seed);
      else
        second = std::min(second, d);
    }
  }
  return {second - nearest, id};
}

struct Texel {
  vec3 color{1};     ///< sRGB-encoded.
  float height = 0;  ///< Metres.
};

uint8_t to_byte(float x) { return static_cast<uint8_t>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f); }

Image blank(const char* name, uint32_t width, uint32_t height) {
  return {
      .name = name, .width = width, .height = height, .rgba = std::vector<uint8_t>(size_t{4} * width * height, 255)};
}

void store(Image& image, uint32_t x, uint32_t y, vec3 color) {
  uint8_t* texel = &image.rgba[4 * (size_t{y} * image.width + x)];
  for (int i = 0; i < 3; ++i) texel[i] = to_byte(color[i]);
}

template <class TexelOf>
Surface make_surface(const char* name, uint32_t size, float metres, TexelOf texel_of) {
  Surface result{blank(name, size, size), blank(name, size, size)};
  result.normal.name += " normal";
  std::vector<float> heights(size_t{size} * size);
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      const Texel texel = texel_of((vec2(x, y) + 0.5f) / static_cast<float>(size));
      heights[size_t{y} * size + x] = texel.height;
      store(result.albedo, x, y, texel.color);
    }
  }
  const auto height = [&](uint32_t x, uint32_t y) { return heights[size_t{y % size} * size + x % size]; };
  const float per_metre = static_cast<float>(size) / (2 * metres);
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      const float dx = (height(x + 1, y) - height(x + size - 1, y)) * per_metre;
      const float dy = (height(x, y + 1) - height(x, y + size - 1)) * per_metre;
      // Rows run down while the normal's y runs up.
      store(result.normal, x, y, glm::normalize(vec3(-dx, dy, 1)) * 0.5f + 0.5f);
    }
  }
  return result;
}

vec3 grey(float value) { return vec3(value); }
float shade_of(const Cell& cell) { return unit_float(mix_bits(cell.id)); }

/// Air and clouds; v from the zenith (0) to the horizon (1), towards: 1 where the sun is, 0 opposite of it.
vec3 evening_air(vec2 uv, float v, float towards) {
  const vec3 zenith{0.20f, 0.31f, 0.52f}, middle{0.45f, 0.56f, 0.70f}, low{0.86f, 0.70f, 0.58f},
      gold{1.0f, 0.74f, 0.42f};
  vec3 color = glm::mix(zenith, middle, ramp(0.05f, 0.80f, v));
  color = glm::mix(color, low, ramp(0.45f, 1.0f, v) * (0.35f + 0.55f * towards));
  color = glm::mix(color, gold, ramp(0.55f, 1.0f, v) * towards * towards * towards);
  // Long thin clouds, lit from below towards the sun.
  const float band = noise(uv, 9, 40, 83) * 0.5f + noise(uv, 21, 96, 89) * 0.3f + noise(uv, 60, 200, 97) * 0.2f;
  const float cloud = ramp(0.50f, 0.76f, band) * ramp(0.30f, 0.62f, v) * (1 - ramp(0.97f, 1.0f, v));
  color = glm::mix(color, glm::mix(vec3(0.50f, 0.48f, 0.56f), vec3(1.0f, 0.70f, 0.50f), towards), 0.65f * cloud);
  const vec2 from_sun = (uv - vec2(0.5f, 0.70f)) * vec2(4.0f, 1.0f);
  const float halo = glm::dot(from_sun, from_sun);
  color = glm::mix(color, vec3(1.0f, 0.80f, 0.52f), 0.75f * std::exp(-40.0f * halo));
  return color + vec3(0.9f, 0.75f, 0.5f) * std::exp(-1100.0f * halo);
}

}  // namespace

Surface make_plaster() {
  return make_surface("plaster", 512, 2, [](vec2 uv) {
    const float rough = fractal(uv, 24, 4, 11), stains = fractal(uv, 3, 3, 17);
    return Texel{grey(0.80f + 0.10f * rough + 0.16f * (stains - 0.4f)), 0.014f * rough};
  });
}

Surface make_masonry() {
  return make_surface("masonry", 512, 2, [](vec2 uv) {
    const Cell stone = brickwork(uv, 5, 8, 23);
    const float grain = fractal(uv, 16, 4, 29), face = ramp(0.02f, 0.16f, stone.edge + 0.06f * (grain - 0.5f));
    const float shade = shade_of(stone);
    const vec3 tint = glm::mix(vec3(0.78f, 0.76f, 0.74f), vec3(0.86f, 0.80f, 0.70f), shade);
    return Texel{glm::mix(grey(0.62f), tint * (0.86f + 0.22f * grain) * (0.88f + 0.2f * shade), face),
                 0.02f * face + 0.012f * grain + 0.008f * shade};
  });
}

Surface make_flagstones() {
  return make_surface("flagstones", 512, 2, [](vec2 uv) {
    const Cell stone = brickwork(uv, 3, 4, 31);
    const float grain = fractal(uv, 12, 5, 37), face = ramp(0.008f, 0.05f, stone.edge), shade = shade_of(stone);
    return Texel{glm::mix(grey(0.5f), vec3(0.80f, 0.78f, 0.75f) * (0.8f + 0.2f * grain + 0.18f * shade), face),
                 0.008f * face + 0.006f * grain};
  });
}

Surface make_cobbles() {
  return make_surface("cobbles", 512, 2, [](vec2 uv) {
    const Cell stone = pebbles(uv, 13, 41);
    const float grain = fractal(uv, 32, 3, 43), face = ramp(0.0f, 0.42f, stone.edge), shade = shade_of(stone);
    const vec3 tint = glm::mix(vec3(0.66f, 0.66f, 0.68f), vec3(0.80f, 0.75f, 0.70f), shade);
    return Texel{
        glm::mix(vec3(0.34f, 0.32f, 0.30f), tint * (0.82f + 0.14f * grain + 0.16f * shade), ramp(0.1f, 0.5f, face)),
        0.022f * face + 0.003f * grain};
  });
}

Surface make_grass() {
  return make_surface("grass", 512, 4, [](vec2 uv) {
    const float blades = noise(uv, 128, 48, 47) * 0.6f + noise(uv, 56, 160, 53) * 0.4f, patches = fractal(uv, 4, 4, 59);
    const vec3 tint = glm::mix(vec3(0.60f, 0.72f, 0.38f), vec3(0.78f, 0.76f, 0.50f), ramp(0.35f, 0.75f, patches));
    return Texel{tint * (0.55f + 0.45f * blades), 0.04f * blades};
  });
}

Surface make_wood() {
  return make_surface("wood", 256, 1, [](vec2 uv) {
    const float grain = noise(uv, 48, 2, 61) * 0.6f + noise(uv, 96, 6, 67) * 0.4f, wear = fractal(uv, 4, 3, 71);
    return Texel{grey(0.62f + 0.30f * grain + 0.14f * (wear - 0.5f)), 0.005f * grain};
  });
}

Surface make_clay() {
  return make_surface("clay", 256, 2, [](vec2 uv) {
    // Tones change over a tile's length; each tile shows another part.
    const float mottle = fractal(uv, 10, 4, 73), tone = noise(uv, 4, 4, 79),
                moss = ramp(0.62f, 0.8f, noise(uv, 5, 5, 81));
    const vec3 fired = glm::mix(vec3(0.66f, 0.62f, 0.62f), vec3(1.0f, 0.97f, 0.92f), ramp(0.2f, 0.8f, tone));
    return Texel{glm::mix(fired * (0.86f + 0.16f * mottle), vec3(0.60f, 0.62f, 0.5f), 0.5f * moss), 0.006f * mottle};
  });
}

Surface make_rows() {
  return make_surface("rows", 512, 4, [](vec2 uv) {
    const float across = 0.5f + 0.5f * std::cos(6.2831853f * 8 * uv.y + 1.6f * fractal(uv, 6, 3, 131));
    const float grain = fractal(uv, 64, 3, 137), patches = fractal(uv, 3, 3, 139);
    return Texel{vec3(1.0f, 0.97f, 0.90f) * (0.45f + 0.22f * across + 0.28f * grain + 0.2f * (patches - 0.4f)),
                 0.08f * across + 0.03f * grain};
  });
}

Surface make_ripples() {
  return make_surface("ripples", 256, 12, [](vec2 uv) {
    const float waves = 0.6f * noise(uv, 14, 30, 149) + 0.3f * noise(uv, 34, 70, 151) + 0.1f * noise(uv, 80, 90, 157);
    return Texel{grey(1), 0.045f * waves};
  });
}

Image make_window_glow() {
  constexpr uint32_t size = 64;
  Image image = blank("window glow", size, size);
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      const vec2 uv = (vec2(x, y) + 0.5f) / static_cast<float>(size);
      const float side = std::abs(uv.x - 0.5f) * 2;
      const float lamp = std::exp(-3.0f * glm::dot(uv - vec2(0.5f, 0.55f), uv - vec2(0.5f, 0.55f)));
      const float folds = 0.8f + 0.2f * std::sin(uv.x * 75.0f);
      const float curtain = ramp(0.42f, 0.60f, side + 0.25f * (0.6f - uv.y));
      store(image, x, y,
            glm::mix(vec3(1.0f, 0.86f, 0.58f) * (0.45f + 0.55f * lamp), vec3(0.86f, 0.52f, 0.26f) * folds * 0.8f,
                     curtain));
    }
  }
  return image;
}

Image make_sky() {
  constexpr uint32_t width = 1024, height = 256;
  Image image = blank("dusk sky", width, height);
  const vec3 zenith{0.10f, 0.14f, 0.27f}, middle{0.25f, 0.31f, 0.47f}, low{0.62f, 0.47f, 0.46f},
      horizon{0.90f, 0.58f, 0.36f};
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const vec2 uv = (vec2(x, y) + 0.5f) / vec2(width, height);
      // The afterglow stands in the north, behind the church (u = 0.5), and the sky is darker opposite of it.
      const float glow = 0.5f - 0.5f * std::cos(6.2831853f * uv.x);
      vec3 color = glm::mix(zenith, middle, ramp(0.15f, 0.75f, uv.y));
      color = glm::mix(color, low, ramp(0.62f, 0.93f, uv.y) * (0.25f + 0.75f * glow));
      color = glm::mix(color, horizon, ramp(0.82f, 1.0f, uv.y) * glow);
      const float band = noise(uv, 7, 24, 83) * 0.5f + noise(uv, 16, 60, 89) * 0.3f + noise(uv, 40, 120, 97) * 0.2f;
      const float cloud = ramp(0.52f, 0.78f, band) * ramp(0.25f, 0.6f, uv.y);
      color =
          glm::mix(color, glm::mix(vec3(0.20f, 0.20f, 0.30f), vec3(0.80f, 0.48f, 0.40f), glow * uv.y), 0.5f * cloud);
      const float dither = (lattice(x, y, 101) - 0.5f) / 255.0f;
      store(image, x, y, color + dither);
    }
  }
  return image;
}

Image make_lake_glow() {
  constexpr uint32_t size = 256;
  Image image = blank("lake glow", size, size);
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      const vec2 uv = (vec2(x, y) + 0.5f) / static_cast<float>(size);
      const float streaks =
          0.5f * noise(uv, 6, 40, 223) + 0.3f * noise(uv, 16, 110, 227) + 0.2f * fractal(uv, 5, 3, 229);
      const float far = std::clamp(1 - uv.x + 0.25f * (streaks - 0.5f), 0.0f, 1.0f);
      vec3 color = glm::mix(vec3(0.27f, 0.35f, 0.46f), vec3(0.80f, 0.60f, 0.46f), ramp(0.15f, 0.75f, far));
      // The hills stand in the water of the far shore.
      color *= 1 - 0.5f * ramp(0.78f, 0.95f, far);
      store(image, x, y, color * (0.86f + 0.28f * (streaks - 0.3f)));
    }
  }
  return image;
}

Image make_evening_sky() {
  constexpr uint32_t width = 2048, height = 512;
  constexpr float horizon = 0.88f, brightest = 0.56f;  // Room above, for the sun.
  Image image = blank("evening sky", width, height);
  for (uint32_t x = 0; x < width; ++x) {
    const float u = (static_cast<float>(x) + 0.5f) / width, towards = 0.5f - 0.5f * std::cos(6.2831853f * u);
    const vec3 haze = glm::mix(vec3(0.42f, 0.47f, 0.60f), vec3(0.84f, 0.60f, 0.46f), towards * towards);
    // Crests of two ridges in the haze, the nearer one lower and darker.
    const std::array crests{horizon - 0.012f - 0.075f * fractal({u, 0.37f}, 6, 6, 211),
                            horizon - 0.075f * fractal({u, 0.57f}, 10, 6, 218)};
    for (uint32_t y = 0; y < height; ++y) {
      const vec2 uv{u, (static_cast<float>(y) + 0.5f) / height};
      vec3 color = evening_air(uv, std::min(uv.y / horizon, 1.0f), towards);
      color = glm::mix(color, haze * 0.86f, ramp(0.0f, 0.0022f, uv.y - crests[0]));
      color = glm::mix(color, haze * 0.62f, ramp(0.0f, 0.0022f, uv.y - crests[1]));
      const float dither = (lattice(x, y, 101) - 0.5f) / 255.0f;
      store(image, x, y, color * brightest + dither);
    }
  }
  return image;
}

}  // namespace app
