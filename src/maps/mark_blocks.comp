#version 460
// Marks what mark_pages would mark for clusters, for the samples in every 4×4 pixels of each instead: what nobody sees between
// them has no pages and keeps no casters. A workgroup a tile, a thread a block.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "maps/map_arrays.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { MarkSamplesPush push; };
#include "clusters/sample.glsl"
#include "maps/mark_box.glsl"

const uint BlockSide = 4u;
const uint BlocksPerRow = TileSide / BlockSide;
const uint Samples = BlockSide * BlockSide;

/// Of the samples of a cluster in a block: a box around their positions and one around their normals.
struct Block {
  Box positions;
  Box normals;
};

vec3 positions[Samples];
vec3 normals[Samples];     // 0: not known
uint slices[Samples];      // NoIndex: background

void read_samples(CameraRecord camera, uvec2 first) {
  [[unroll]] for (uint i = 0u; i < Samples; ++i) {
    uvec2 pixel = first + uvec2(i % BlockSide, i / BlockSide);
    slices[i] = NoIndex;
    normals[i] = vec3(0.0);
    if (any(greaterThanEqual(pixel, camera.size)) || !read_sample(camera, ivec2(pixel), slices[i], positions[i])) slices[i] = NoIndex;
    else if (!read_normal(ivec2(pixel), normals[i])) normals[i] = vec3(0.0);
  }
}

/// samples: bits of those of the slice.
Block block_of(uint samples) {
  const Box empty = Box(vec3(1e30), vec3(-1e30));
  Block block = Block(empty, empty);
  [[unroll]] for (uint i = 0u; i < Samples; ++i) {
    bool is_in = (samples >> i & 1u) != 0u;
    block.positions.lo = min(block.positions.lo, is_in ? positions[i] : block.positions.lo);
    block.positions.hi = max(block.positions.hi, is_in ? positions[i] : block.positions.hi);
    bool is_known = normals[i] != vec3(0.0);
    block.normals.lo = min(block.normals.lo, is_in ? is_known ? normals[i] : vec3(-1.0) : block.normals.lo);
    block.normals.hi = max(block.normals.hi, is_in ? is_known ? normals[i] : vec3(1.0) : block.normals.hi);
  }
  // Hosts compute positions with other roundings, and keep normals with few bits.
  vec3 largest = max(abs(block.positions.lo), abs(block.positions.hi));
  float slack = max(largest.x, max(largest.y, largest.z)) * 2e-6;
  block.positions = Box(block.positions.lo - slack, block.positions.hi + slack);
  block.normals = Box(block.normals.lo - 0.01, block.normals.hi + 0.01);
  return block;
}

/// True when no normal of the block has a positive product with a direction to the light from one of its positions.
bool block_faces_away(Block block, LightRecord light) {
  bool sun = light.type == LightDirectional;
  vec3 lo = sun ? -light.direction_ws : light.position_ws - block.positions.hi;
  vec3 hi = sun ? -light.direction_ws : light.position_ws - block.positions.lo;
  vec3 most = max(max(block.normals.lo * lo, block.normals.lo * hi), max(block.normals.hi * lo, block.normals.hi * hi));
  return most.x + most.y + most.z <= 0.0;
}

void mark_block(FrameRecord frame, Block block, ClusterList list) {
  for (uint pair = list.first; pair < list.first + list.count; ++pair) {
    uint map_index = Uints(frame.pair_maps).v[pair];
    if (map_index == NoIndex) continue;
    MapRecord map = Maps(frame.maps).v[map_index];
    LightRecord light = Lights(frame.lights).v[map.light];
    if (!light_shines_on(light, block.positions)) continue;
    if (push.drop_facing_away != 0u && block_faces_away(block, light)) continue;
    mark_box(frame, map_index, map, block.positions);
  }
}

void main() {
  if (Counters(push.counters).counters.fit_map_groups[0] == 0u) return;   // nothing to mark, or a round before fitted the budget
  CameraRecord camera = Cameras(push.camera).v[0];
  FrameRecord frame = Frame(push.frame).record;
  uvec2 own = uvec2(gl_LocalInvocationIndex % BlocksPerRow, gl_LocalInvocationIndex / BlocksPerRow);
  read_samples(camera, gl_WorkGroupID.xy * TileSide + own * BlockSide);
  uint tile = camera.first_tile + gl_WorkGroupID.y * camera.tiles.x + gl_WorkGroupID.x;
  uint left = 0u;   // samples
  [[unroll]] for (uint i = 0u; i < Samples; ++i) left |= uint(slices[i] != NoIndex) << i;
  while (left != 0u) {
    uint slice = slices[findLSB(left)];
    uint samples = 0u;
    [[unroll]] for (uint i = 0u; i < Samples; ++i) samples |= uint(slices[i] == slice) << i;
    left &= ~samples;
    ClusterList list = list_of_slice(frame, tile, slice);
    if (list.first != NoIndex) mark_block(frame, block_of(samples), list);   // else looked up in whole maps
  }
}
