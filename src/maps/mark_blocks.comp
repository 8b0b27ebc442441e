#version 460
// Marks what mark_pages would mark for clusters, for the samples in every 4×4 pixels of each instead: what nobody sees between
// them has no pages and keeps no casters. A workgroup a cluster, a thread a block of its tile.
#extension GL_GOOGLE_include_directive : require
#include "maps/map_arrays.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock { MarkSamplesPush push; };
#include "clusters/sample.glsl"
#include "maps/mark_box.glsl"

const uint BlockSide = 4u;
const uint BlocksPerRow = TileSide / BlockSide;

/// Of the samples of a cluster in a block: a box around their positions and one around their normals.
struct Block {
  Box positions;
  Box normals;
};

Block read_block(CameraRecord camera, uvec2 first, uint slice) {
  const Box empty = Box(vec3(1e30), vec3(-1e30));
  Block block = Block(empty, empty);
  for (uint i = 0u; i < BlockSide * BlockSide; ++i) {
    uvec2 pixel = first + uvec2(i % BlockSide, i / BlockSide);
    uint sample_slice;
    vec3 position;
    if (any(greaterThanEqual(pixel, camera.size)) || !read_sample(camera, ivec2(pixel), sample_slice, position) || sample_slice != slice) continue;
    block.positions = Box(min(block.positions.lo, position), max(block.positions.hi, position));
    vec3 normal;
    if (read_normal(ivec2(pixel), normal)) block.normals = Box(min(block.normals.lo, normal), max(block.normals.hi, normal));
    else block.normals = Box(vec3(-1.0), vec3(1.0));
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

void main() {
  uint cluster = group_index();
  if (cluster >= Counters(push.counters).counters.clusters) return;
  FrameRecord frame = Frame(push.frame).record;
  ClusterList list = ClusterLists(frame.cluster_lists).v[cluster];
  if (list.first == NoIndex) return;   // looked up in whole maps
  uint cell = Uints(frame.cluster_cells).v[cluster];
  CameraRecord camera = Cameras(push.camera).v[0];
  uint tile_index = cell / MaxSlices;
  if (tile_index < camera.first_tile || tile_index >= camera.end_tile) return;   // of another camera, whose images are not at hand
  tile_index -= camera.first_tile;
  uvec2 tile = uvec2(tile_index % camera.tiles.x, tile_index / camera.tiles.x);
  uvec2 own = uvec2(gl_LocalInvocationIndex % BlocksPerRow, gl_LocalInvocationIndex / BlocksPerRow);
  Block block = read_block(camera, tile * TileSide + own * BlockSide, cell % MaxSlices);
  if (block.positions.lo.x > block.positions.hi.x) return;
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
