#version 460
// O1, O9: which clusters the samples of a tile occupy, the bits of their explicit bounds and of their normals. A workgroup a
// tile: samples or their bits in shared memory, one atomicOr each (two with normals), and nothing global.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "clusters/cluster_buffers.glsl"
#include "clusters/normal_cone.shared.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { AssignPush push; };
layout(set = 0, binding = 0) uniform texture2D depth_image;
layout(set = 0, binding = 1) uniform texture2D normal_image;

shared uint bits[MaxSlices];
shared uint normals_low[MaxSlices];
shared uint normals_high[MaxSlices];
shared uint occupied[SliceWords];

const uint threads = 64u;

/// False when the host has no normals or this one is not a direction.
bool read_normal(ivec2 pixel, out vec3 normal) {
  if (push.normal_encoding == 0u) return false;
  vec3 texel = texelFetch(normal_image, pixel, 0).xyz;
  normal = push.normal_encoding == 1u ? from_octahedral(texel.xy) : push.normal_encoding == 2u ? texel * 2.0 - 1.0 : texel;
  float size = dot(normal, normal);
  return size > 0.25 && size < 4.0;
}

void assign(CameraRecord camera, uvec2 tile, ivec2 pixel) {
  float depth = texelFetch(depth_image, pixel, 0).x;
  if (is_background(depth)) return;
  float t = view_depth(camera, depth);
  uint slice = slice_of(camera, t);
  vec3 position = world_position(camera, ndc_of_pixel(camera, vec2(pixel) + 0.5), t);
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
  CameraRecord camera = Frame(push.frame).record.camera;
  uvec2 tile = gl_WorkGroupID.xy;
  uint tile_index = tile.y * camera.tiles.x + tile.x;
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
