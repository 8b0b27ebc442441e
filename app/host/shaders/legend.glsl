// Text, numbers and legends of debug pictures. Before it: push, a ShowPush.

// 3x5 glyphs of the characters 32…95, rows from the top, the high bit first.
const uint glyphs[64] = uint[](
    0x0000u, 0x0000u, 0x0000u, 0x0000u, 0x0000u, 0x0000u, 0x0000u, 0x0000u,
    0x1491u, 0x4494u, 0x0000u, 0x05d0u, 0x0014u, 0x01c0u, 0x0002u, 0x12a4u,
    0x7b6fu, 0x2c97u, 0x73e7u, 0x73cfu, 0x5bc9u, 0x79cfu, 0x79efu, 0x7249u,
    0x7befu, 0x7bcfu, 0x0410u, 0x0000u, 0x0000u, 0x0e38u, 0x0000u, 0x0000u,
    0x0000u, 0x2bedu, 0x6baeu, 0x3923u, 0x6b6eu, 0x79a7u, 0x79a4u, 0x396bu,
    0x5bedu, 0x7497u, 0x126au, 0x5badu, 0x4927u, 0x5fedu, 0x6b6du, 0x2b6au,
    0x6ba4u, 0x2b73u, 0x6badu, 0x388eu, 0x7492u, 0x5b6fu, 0x5b6au, 0x5bfdu,
    0x5aadu, 0x5a92u, 0x72a7u, 0x0000u, 0x0000u, 0x0000u, 0x0000u, 0x0000u);

const vec3 legend_ink = vec3(1.0);
const vec3 legend_paper = vec3(0.06);

/// Pixels along a glyph's dot.
int text_scale(ivec2 size) { return clamp(min(size.x / 320, size.y / 180), 1, 3); }
int text_height(int scale) { return 5 * scale; }
int char_width(int scale) { return 4 * scale; }

bool in_char(ivec2 pixel, ivec2 corner, int scale, uint character) {
  ivec2 cell = pixel - corner;
  if (any(lessThan(cell, ivec2(0)))) return false;
  cell /= scale;
  if (cell.x >= 3 || cell.y >= 5 || character < 32u) return false;
  if (character >= 97u && character <= 122u) character -= 32u;
  return character < 96u && (glyphs[character - 32u] >> (14 - (cell.y * 3 + cell.x)) & 1u) != 0u;
}

int digits_of(uint number) {
  int length = 1;
  for (uint rest = number / 10u; rest > 0u; rest /= 10u) ++length;
  return length;
}

/// Is the pixel inside the decimal number whose top left corner is at `corner`?
bool in_number(ivec2 pixel, ivec2 corner, int scale, uint number) {
  int place = (pixel.x - corner.x) / char_width(scale), length = digits_of(number);
  if (pixel.x < corner.x || place >= length) return false;
  for (int i = place + 1; i < length; ++i) number /= 10u;
  return in_char(pixel, corner + ivec2(place * char_width(scale), 0), scale, 48u + number % 10u);
}

/// 2^exponent: 16K … 4, 2, 1, 1/2, 1/4 …
bool in_power(ivec2 pixel, ivec2 corner, int scale, int exponent) {
  int step_px = char_width(scale);
  if (exponent >= 14) {
    uint thousands = 1u << exponent - 10;
    return in_number(pixel, corner, scale, thousands) || in_char(pixel, corner + ivec2(digits_of(thousands) * step_px, 0), scale, 75u);
  }
  if (exponent >= 0) return in_number(pixel, corner, scale, 1u << exponent);
  return in_char(pixel, corner, scale, 49u) || in_char(pixel, corner + ivec2(step_px, 0), scale, 47u) ||
         in_number(pixel, corner + ivec2(2 * step_px, 0), scale, 1u << -exponent);
}

uint title_char(int place) { return place < 64 ? push.title[place / 4] >> 8 * (place % 4) & 0xffu : 0u; }

int title_length() {
  int length = 0;
  while (title_char(length) != 0u) ++length;
  return length;
}

bool in_title(ivec2 pixel, ivec2 corner, int scale) {
  int place = (pixel.x - corner.x) / char_width(scale);
  return pixel.x >= corner.x && in_char(pixel, corner + ivec2(place * char_width(scale), 0), scale, title_char(place));
}

bool in_box(ivec2 pixel, ivec2 corner, ivec2 size) {
  return all(greaterThanEqual(pixel, corner)) && all(lessThan(pixel, corner + size));
}

const uint NoNumber = 0xfffffffeu;

/// The title over a picture, in its bottom left corner, with a light's number after it (NoLight: a dash), or NoNumber.
vec3 with_title(ivec2 pixel, ivec2 size, uint number, vec3 under) {
  int scale = text_scale(size), pad = 3 * scale;
  int characters = title_length() + (number == NoNumber ? 0 : number == NoLight ? 2 : digits_of(number) + 1);
  ivec2 corner = ivec2(2 * pad, size.y - 2 * pad - text_height(scale));
  if (!in_box(pixel, corner - pad, ivec2(characters * char_width(scale), text_height(scale)) + 2 * pad)) return under;
  ivec2 number_corner = corner + ivec2((title_length() + 1) * char_width(scale), 0);
  bool ink = in_title(pixel, corner, scale);
  if (number == NoLight) ink = ink || in_char(pixel, number_corner, scale, 45u);
  else if (number != NoNumber) ink = ink || in_number(pixel, number_corner, scale, number);
  return ink ? legend_ink : legend_paper;
}

const uint LegendOutside = 0u;
const uint LegendPaper = 1u;
const uint LegendInk = 2u;
const uint LegendField = 3u;

/// A row of `count` fields above the title, one for each power of two from 2^first on. LegendField: `exponent` is that of
/// the field that holds the pixel.
uint legend_at(ivec2 pixel, ivec2 size, int first, int count, out int exponent) {
  int scale = text_scale(size), label_scale = max(scale - 1, 1), pad = 3 * scale;
  ivec2 field = ivec2(18 * label_scale, 6 * scale);
  ivec2 whole = ivec2(count * field.x, field.y + scale + text_height(label_scale));
  ivec2 corner = ivec2(2 * pad, size.y - 5 * pad - text_height(scale) - whole.y);
  int place = clamp((pixel.x - corner.x) / field.x, 0, count - 1);
  exponent = first + place;
  if (!in_box(pixel, corner - pad, whole + 2 * pad)) return LegendOutside;
  if (in_box(pixel, corner, ivec2(whole.x, field.y))) return LegendField;
  ivec2 label = corner + ivec2(place * field.x, field.y + scale);
  return in_power(pixel, label, label_scale, exponent) ? LegendInk : LegendPaper;
}
