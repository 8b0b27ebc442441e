#version 460
// How much of the pool each page word needs; the scan turns it into places.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_buffers.glsl"
layout(local_size_x = 64) in;

/// The map to whose views a word belongs: maps lie in order, so that it is the last that begins at or before it.
MapRecord map_of_word(FrameRecord frame, uint word) {
  uint low = 0u;
  uint high = Counters(push.counters).counters.maps;
  while (high - low > 1u) {
    uint middle = (low + high) / 2u;
    if (Maps(frame.maps).v[middle].first_word <= word) low = middle;
    else high = middle;
  }
  return Maps(frame.maps).v[low];
}

void main() {
  uint word = global_index(64u);
  if (word >= Counters(push.counters).counters.page_words) return;
  FrameRecord frame = Frame(push.frame).record;
  uint pages = uint(bitCount(Uints(frame.page_bits).v[word]));
  uint units = pages == 0u ? 0u : pages * page_units_of(map_of_word(frame, word).resolution);
  Uints(frame.page_first).v[word] = units;
  if (pages == 0u) return;   // most: that few atomics are cheaper than barriers
  atomicAdd(Counters(push.counters).counters.pages, pages);
  // Saturates: what is beyond 2^31 units (137 GB) is too much whatever it is.
  if (atomicAdd(Counters(push.counters).counters.pool_units, units) > 0x80000000u)
    atomicMin(Counters(push.counters).counters.pool_units, 0x80000000u);
}
