#version 460
// Work items → draws: a command an item, an instance for each of its views.
#extension GL_GOOGLE_include_directive : require
#include "raster/page_buffers.glsl"
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
    PageInstance drawn;
    drawn.row0 = vec4(instance.row0.xyz, instance.row0.w - view.origin.x);
    drawn.row1 = vec4(instance.row1.xyz, instance.row1.w - view.origin.y);
    drawn.row2 = vec4(instance.row2.xyz, instance.row2.w - view.origin.z);
    drawn.x_row = vec4(view.x_row, float(map.resolution));
    drawn.y_row = vec4(view.y_row, 0.0);
    drawn.z_row = vec4(view.z_row, view.z_offset);
    drawn.w_row = vec4(view.w_row, view.w_offset);
    drawn.positions = instance.positions;
    drawn.position_stride = instance.position_stride;
    drawn.batch = caster.batch;
    drawn.uvs = instance.uvs;
    drawn.uv_stride = instance.uv_stride;
    drawn.first_word = map.first_word + face * map.words;
    Drawn(push.drawn).v[place++] = drawn;
  }
  Commands(push.commands).v[index] =
      DrawCommand(batch.index_count, uint(bitCount(item.faces)), batch.first_index, 0, index * CubeFaceCount);
}
