// stb_image's functions for tests that read PNGs back.
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // GCC 14, where it inlines the handling of a PNG's colour key
#include <stb/stb_image.h>
