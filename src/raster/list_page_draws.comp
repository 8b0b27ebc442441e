#version 460
// Work items → draws: a command an item, an instance for each of its views.
#extension GL_GOOGLE_include_directive : require
#include "raster/page_buffers.glsl"
#include "raster/page_instance.glsl"
layout(local_size_x = RasterThreads) in;
layout(push_constant, scalar) uniform PushBlock { ListDrawsPush push; };

UMB_ARRAY(Drawn, PageInstance, 8);
UMB_ARRAY(Commands, DrawCommand, 4);

void main() {
  DrawCounts counts = ItemCounts(push.counts).v;
  uint items = min(push.masked != 0u ? counts.masked : counts.opaque, push.item_capacity);
  uint draws = min(items - min(items, push.first), push.window);
  uint index = gl_GlobalInvocationID.x;
  if (index == 0u) Uints(push.draw_count).v[0] = draws;
  if (index >= draws) return;
  CasterItem item = Items(push.items).v[push.first + index + (push.masked != 0u ? push.item_capacity : 0u)];
  Frame frame = Frame(push.frame);
  MapRecord map = Maps(frame.v.maps).v[item.map];
  CasterRecord caster = Casters(push.casters).v[item.caster];
  InstanceRecord instance = Instances(push.instances).v[caster.instance];
  BatchRecord batch = Batches(push.batches).v[caster.batch];
  uint place = index * CubeFaceCount;
  for (uint faces = item.faces; faces != 0u; faces &= faces - 1u) {
    uint face = uint(findLSB(faces));
    ShadowView view = Views(frame.v.views).v[map.first_view + face];
    Drawn(push.drawn).v[place++] = page_instance(instance, view, map, face, caster.batch);
  }
  Commands(push.commands).v[index] =
      DrawCommand(batch.index_count, uint(bitCount(item.faces)), batch.first_index, 0, index * CubeFaceCount);
}
