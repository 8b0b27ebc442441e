#version 460
// Where shaders cannot ask what is resident.
#extension GL_GOOGLE_include_directive : require
#include "raster/write_texel.glsl"
