#version 460
// Empties the page words, projection maps and depth grids of a map; those of a map for points anywhere are filled. A workgroup a map.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;

void main() {
  FrameRecord frame = Frame(push.frame).record;
  MapRecord map = Maps(frame.maps).v[group_index()];
  bool filled = map.receivers == ReceiversAnywhere;
  uint thread = gl_LocalInvocationIndex;
  uint pages = map.pages * map.pages;
  for (uint i = thread; i < map.words * map.view_count; i += 64u) {
    uint left = pages - (i % map.words) * 32u;   // pages from this word on
    uint bits = left >= 32u ? 0xffffffffu : (1u << left) - 1u;
    Uints(frame.page_bits).v[map.first_word + i] = filled ? bits : 0u;
  }
  uint first_row = map.first_receiver * ProjectionSide;
  for (uint i = thread; i < map.view_count * ProjectionSide; i += 64u) Uints(frame.projection).v[first_row + i] = filled ? 0xffffffffu : 0u;
  uint cells = frame.receiver_grid * frame.receiver_grid;
  for (uint i = thread; i < map.view_count * cells; i += 64u)
    Uints(frame.receiver_depth).v[map.first_receiver * cells + i] = filled ? floatBitsToUint(1e30) : 0u;
}
