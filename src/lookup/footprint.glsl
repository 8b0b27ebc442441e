// How large shadow texels are on a surface; a part of umbrage.glsl.

/// Slides a step along the ray through the point until it lies on the receiver's plane; grazing planes are cut off at a slope of 50.
UMB_FN vec3 step_on_plane(vec3 texel_step, vec3 ray, vec3 normal) {
  float slope = dot(normal, ray);
  float least = 0.02f * length(ray);
  if (abs(slope) < least) slope = slope < 0.0f ? -least : least;
  return texel_step - ray * (dot(normal, texel_step) / slope);
}

/// One step along each axis of the shadow map used at a point, as vectors on the receiver's plane (0 for lights without one).
void umbrage_texel_footprint(Frame frame, Cluster cluster, uint i, vec3 position_ws, vec3 normal_ws, out vec3 du_ws, out vec3 dv_ws) {
  Light light = umbrage_light(frame, cluster, i);
  du_ws = vec3(0.0f);
  dv_ws = vec3(0.0f);
  uint first = light.type == LightDirectional ? first_cascade(frame, light.index) : NoIndex;
  if (first != NoIndex) {
    UmbrageCascadeTables table = UmbrageCascadeTables(frame.cascades);
    uint index = cascade_at(table, first, camera_depth(frame, position_ws), position_ws);
    if (index == NoIndex) return;
    CascadeRecord cascade = table.v[0].records[index];
    du_ws = step_on_plane(cascade.x_row * (cascade.texel_m * cascade.texel_m), cascade.z_row, normal_ws);
    dv_ws = step_on_plane(cascade.y_row * (cascade.texel_m * cascade.texel_m), cascade.z_row, normal_ws);
    return;
  }
  if (light.view_count == 0u) return;
  Map map = map_of_light(frame, light);
  if (map.resolution == 0u) return;
  ShadowView view = UmbrageViews(frame.views).v[map.first_view];
  vec3 relative = position_ws - light.position_ws;
  vec3 ray = relative;   // from the light through the point
  vec3 step_u;
  vec3 step_v;
  if (light.views == ViewsOrtho) {
    ray = -view.z_row;
    step_u = normalize(view.x_row) * (view.side_m / float(map.resolution));
    step_v = normalize(view.y_row) * (view.side_m / float(map.resolution));
  } else {
    vec3 x_axis = view.x_row * view.tangent;
    vec3 y_axis = view.y_row * view.tangent;
    float depth = dot(view.w_row, relative);
    if (light.views == ViewsCube) {
      uint face = face_of_direction(relative);
      depth = face_coordinates(face, relative).z;
      x_axis = face_direction(face, 1.0f, 0.0f) - face_direction(face, 0.0f, 0.0f);
      y_axis = face_direction(face, 0.0f, 1.0f) - face_direction(face, 0.0f, 0.0f);
    }
    float size = texel_size_m(depth, view.tangent, map.resolution);
    step_u = x_axis * size;
    step_v = y_axis * size;
  }
  du_ws = step_on_plane(step_u, ray, normal_ws);
  dv_ws = step_on_plane(step_v, ray, normal_ws);
}
