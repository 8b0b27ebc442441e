// A batch in one view of a map, as cast_view.glsl takes it.

PageInstance page_instance(InstanceRecord instance, ShadowView view, MapRecord map, uint face, uint batch) {
  PageInstance drawn;
  drawn.row0 = vec4(instance.row0.xyz, instance.row0.w - view.origin.x);
  drawn.row1 = vec4(instance.row1.xyz, instance.row1.w - view.origin.y);
  drawn.row2 = vec4(instance.row2.xyz, instance.row2.w - view.origin.z);
  drawn.x_row = vec4(view.x_row, float(map.resolution));
  drawn.y_row = vec4(view.y_row, float(map.layer + face));
  drawn.z_row = vec4(view.z_row, view.z_offset);
  drawn.w_row = vec4(view.w_row, view.w_offset);
  drawn.positions = instance.positions;
  drawn.position_stride = instance.position_stride;
  drawn.batch = batch;
  drawn.uvs = instance.uvs;
  drawn.uv_stride = instance.uv_stride;
  drawn.first_word = map.first_word + face * map.words;
  drawn.plane = vec4(view.x_offset, view.y_offset, view.grid, 0.0);
  return drawn;
}
