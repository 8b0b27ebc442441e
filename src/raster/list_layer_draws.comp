#version 460
// O12: work items → draws, image by image: a command an item, an instance for each of its faces. The order of an image's draws
// is free: the nearest depth stays.
#extension GL_GOOGLE_include_directive : require
#include "raster/page_buffers.glsl"
#include "raster/page_instance.glsl"
layout(local_size_x = RasterThreads) in;
layout(push_constant, scalar) uniform PushBlock { ListLayersPush push; };

UMB_ARRAY(Drawn, PageInstance, 8);
UMB_ARRAY(Commands, DrawCommand, 4);

void main() {
  DrawCounts counts = ItemCounts(push.counts_of_items).v;
  uint opaque = min(counts.opaque, push.item_capacity);
  uint index = gl_GlobalInvocationID.x;
  if (index >= min(opaque + counts.masked, push.item_capacity)) return;
  bool masked = index >= opaque;
  CasterItem item = Items(push.items).v[masked ? push.item_capacity + index - opaque : index];
  Frame frame = Frame(push.frame);
  MapRecord map = Maps(frame.v.maps).v[item.map];
  CasterRecord caster = Casters(push.casters).v[item.caster];
  InstanceRecord instance = Instances(push.instances).v[caster.instance];
  BatchRecord batch = Batches(push.batches).v[caster.batch];
  uint place = index * CubeFaceCount;
  uint views = uint(bitCount(item.faces));
  for (uint i = 0u; i < views; ++i) {
    uint face = nth_set_bit(item.faces, i);
    ShadowView view = Views(frame.v.views).v[map.first_view + face];
    Drawn(push.drawn).v[place + i] = page_instance(instance, view, map, face, caster.batch);
  }
  uint list = (masked ? push.image_count : 0u) + map.image;
  uint command = list * push.item_capacity + atomicAdd(Uints(push.counts).v[list], 1u);
  Commands(push.commands).v[command] = DrawCommand(batch.index_count, views, batch.first_index, 0, place);
}
