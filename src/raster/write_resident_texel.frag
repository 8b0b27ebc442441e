#version 460
// Where shaders can ask what is resident.
#extension GL_GOOGLE_include_directive : require
#define ASKS_RESIDENCY
#include "raster/write_texel.glsl"
