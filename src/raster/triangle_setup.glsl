// Work items → triangles on their maps, clipped and in fixed point: a workgroup an item, a thread a triangle. Includer: `masked`,
// push, take_triangle for each piece of a triangle that may cover texels, end_triangle after its last.

Pool pool;
MapRecord map;
uint map_index;
uint batch_index;
float near_m;

/// narrow: its edge functions have 32 bits everywhere.
void take_triangle(RasterTriangle t, bool narrow);
void end_triangle();

void set_up_placed(uint view, ClipVertex a, ClipVertex b, ClipVertex c) {
  PlacedVertex p0, p1, p2;
  if (!place_vertex(a.position, map.resolution, p0) || !place_vertex(b.position, map.resolution, p1) ||
      !place_vertex(c.position, map.resolution, p2)) return;
  ivec2 lo = ivec2(min(p0.x, min(p1.x, p2.x)), min(p0.y, min(p1.y, p2.y)));
  ivec2 hi = ivec2(max(p0.x, max(p1.x, p2.x)), max(p0.y, max(p1.y, p2.y)));
  bool narrow = max(hi.x - lo.x, hi.y - lo.y) <= NarrowTexels * SubTexels;
  ivec2 ab = ivec2(p1.x - p0.x, p1.y - p0.y);
  ivec2 ac = ivec2(p2.x - p0.x, p2.y - p0.y);
  float area;
  if (narrow) {
    int exact = ab.x * ac.y - ab.y * ac.x;
    area = float(exact);
  } else {
    int64_t exact = int64_t(ab.x) * int64_t(ac.y) - int64_t(ab.y) * int64_t(ac.x);
    area = float(exact);
  }
  if (area == 0.0) return;
  if (area < 0.0) {
    PlacedVertex p = p1;
    p1 = p2;
    p2 = p;
    ClipVertex v = b;
    b = c;
    c = v;
  }
  RasterTriangle t;
  t.x0 = p0.x, t.y0 = p0.y, t.x1 = p1.x, t.y1 = p1.y, t.x2 = p2.x, t.y2 = p2.y;
  precise float scale = float(SubTexels) / abs(area);
  precise vec3 z = vec3(p0.z, p1.z, p2.z) * scale;
  t.z = z;
  t.z_min = min(p0.z, min(p1.z, p2.z));
  t.z_max = max(p0.z, max(p1.z, p2.z));
  t.map = map_index;
  t.view = view;
  t.batch = masked ? batch_index : NoIndex;
  t.q = vec3(p0.reciprocal_w, p1.reciprocal_w, p2.reciprocal_w);
  t.u = vec3(a.uv.x, b.uv.x, c.uv.x) * t.q;
  t.v = vec3(a.uv.y, b.uv.y, c.uv.y) * t.q;
  take_triangle(t, narrow);
}

/// All vertices beyond one side of the view, its near or its far plane.
bool is_outside(vec4 a, vec4 b, vec4 c) {
  vec3 w = vec3(a.w, b.w, c.w);
  vec3 x = vec3(a.x, b.x, c.x);
  vec3 y = vec3(a.y, b.y, c.y);
  vec3 z = vec3(a.z, b.z, c.z);
  return all(greaterThan(x, w)) || all(lessThan(x, -w)) || all(greaterThan(y, w)) || all(lessThan(y, -w)) || all(greaterThan(z, w)) ||
         all(lessThan(z, vec3(0.0)));
}

void set_up_triangle(uint view, ClipVertex a, ClipVertex b, ClipVertex c) {
  if (is_outside(a.position, b.position, c.position)) return;
  float guard = clip_guard(map.resolution);
  ClipVertex corner[9];
  uint count = 3u;
  if (!is_inside_guard(a.position, guard) || !is_inside_guard(b.position, guard) || !is_inside_guard(c.position, guard)) {
    corner[0] = a, corner[1] = b, corner[2] = c;
    count = clip_triangle(corner, guard);
    if (count < 3u) return;
    a = corner[0], b = corner[1], c = corner[2];
  }
  for (uint next = 3u;; ++next) {
    set_up_placed(view, a, b, c);
    if (next >= count) return;
    b = c;
    c = corner[next];
  }
}

/// The share of a workgroup: an item, a thread a triangle.
void set_up_item() {
  DrawCounts counts = ItemCounts(push.counts).v;
  uint index = group_index();
  if (index >= min(masked ? counts.masked : counts.opaque, push.item_capacity)) return;
  CasterItem item = Items(push.items).v[index + (masked ? push.item_capacity : 0u)];
  Frame frame = Frame(push.frame);
  pool = pool_of(frame);
  map_index = item.map;
  map = Maps(frame.v.maps).v[item.map];
  CasterRecord caster = Casters(push.casters).v[item.caster];
  InstanceRecord instance = Instances(push.instances).v[caster.instance];
  BatchRecord batch = Batches(push.batches).v[caster.batch];
  batch_index = caster.batch;
  ShadowView view = Views(frame.v.views).v[map.first_view];
  near_m = view.near_m;
  precise vec3 translation = vec3(instance.row0.w, instance.row1.w, instance.row2.w) - view.origin;
  for (uint triangle = gl_LocalInvocationIndex; triangle < batch.triangle_count; triangle += RasterThreads) {
    vec3 relative[3];
    vec2 uv[3];
    for (uint i = 0u; i < 3u; ++i) {
      uint vertex = Uints(push.indices).v[batch.first_index + 3u * triangle + i];
      Floats position = Floats(instance.positions);
      uint at = vertex * instance.position_stride;
      vec3 p = vec3(position.v[at], position.v[at + 1u], position.v[at + 2u]);
      precise vec3 r = vec3(dot(instance.row0.xyz, p), dot(instance.row1.xyz, p), dot(instance.row2.xyz, p)) + translation;
      relative[i] = r;
      uv[i] = vec2(0.0);
      uint uv_at = vertex * instance.uv_stride;
      if (masked) uv[i] = vec2(Floats(instance.uvs).v[uv_at], Floats(instance.uvs).v[uv_at + 1u]);
    }
    for (uint faces = item.faces; faces != 0u; faces &= faces - 1u) {
      uint face = uint(findLSB(faces));
      ClipVertex a = ClipVertex(clip_position(view, map.kind, face, relative[0]), uv[0]);
      ClipVertex b = ClipVertex(clip_position(view, map.kind, face, relative[1]), uv[1]);
      ClipVertex c = ClipVertex(clip_position(view, map.kind, face, relative[2]), uv[2]);
      set_up_triangle(face, a, b, c);
      end_triangle();
    }
  }
}
