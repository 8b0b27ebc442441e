#version 460
// O1, O9: which clusters the samples of a tile occupy, the bits of their explicit bounds and of their normals. A workgroup a
// tile: samples or their bits in shared memory, one atomicOr each (two with normals), and nothing global.
#extension GL_GOOGLE_include_directive : require
#include "clusters/cluster_buffers.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { AssignPush push; };
#include "clusters/sample.glsl"

shared uint bits[MaxSlices];
shared uint normals_low[MaxSlices];
shared uint normals_high[MaxSlices];
shared uint occupied[SliceWords];

const uint threads = 64u;

void assign(CameraRecord camera, uvec2 tile, ivec2 pixel) {
  uint slice;
  vec3 position;
  if (!read_sample(camera, pixel, slice, position)) return;
  atomicOr(bits[slice], sample_bits(position, cell_box(camera, tile, slice)));
  vec3 normal;
  if (!read_normal(pixel, normal)) {
    if (push.normal_encoding != 0u) {
      normals_low[slice] = 0xffffffffu;
      normals_high[slice] = 0xffffffffu;
    }
    return;
  }
  uint cell = normal_cell(normal);
  if (cell < 32u) atomicOr(normals_low[slice], 1u << cell);
  else atomicOr(normals_high[slice], 1u << (cell - 32u));
}

void main() {
  CameraRecord camera = Cameras(push.camera).v[0];
  uvec2 tile = gl_WorkGroupID.xy;
  uint tile_index = camera.first_tile + tile.y * camera.tiles.x + tile.x;
  uint thread = gl_LocalInvocationIndex;
  for (uint slice = thread; slice < MaxSlices; slice += threads) {
    bits[slice] = 0u;
    normals_low[slice] = 0u;
    normals_high[slice] = 0u;
  }
  if (thread < SliceWords) occupied[thread] = 0u;
  barrier();

  for (uint i = thread; i < TileSide * TileSide; i += threads) {
    uvec2 pixel = tile * TileSide + uvec2(i % TileSide, i / TileSide);
    if (pixel.x < camera.size.x && pixel.y < camera.size.y) assign(camera, tile, ivec2(pixel));
  }
  barrier();

  for (uint slice = thread; slice < MaxSlices; slice += threads)
    if (bits[slice] != 0u) atomicOr(occupied[slice >> 5], 1u << (slice & 31u));
  barrier();

  uint total = 0u;
  for (uint word = 0u; word < SliceWords; ++word) {
    uint mask = occupied[word];
    if (thread == word) ClusterWords(push.words).v[tile_index * SliceWords + word] = ClusterWord(mask, total);
    for (uint slice = word * 32u + thread; slice < word * 32u + 32u; slice += threads) {
      uint bit = slice & 31u;
      if ((mask & (1u << bit)) == 0u) continue;
      uint local = total + bitCount(mask & ((1u << bit) - 1u));
      FoundClusters(push.found).v[tile_index * MaxSlices + local] = FoundCluster(bits[slice], normals_low[slice], normals_high[slice], slice);
    }
    total += bitCount(mask);
  }
  if (thread == 0u) Uints(push.tile_counts).v[tile_index] = total;
}
