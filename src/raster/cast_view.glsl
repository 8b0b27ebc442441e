// A caster's vertex in a view of a map, for cast_page.vert and cast_layer.vert. Every map begins at the viewport's corner; clip
// distances cut a texel beyond its side. Expects `push`.

layout(location = 0) in vec4 row0;
layout(location = 1) in vec4 row1;
layout(location = 2) in vec4 row2;
layout(location = 3) in vec4 x_row;
layout(location = 4) in vec4 y_row;
layout(location = 5) in vec4 z_row;
layout(location = 6) in vec4 w_row;
layout(location = 7) in uvec4 geometry;             // positions, their stride, batch
layout(location = 8) in uvec4 texture_coordinates;  // address, stride; first word of the page bits
layout(location = 9) in vec4 plane;                 // offset of clip x and y; grid

out float gl_ClipDistance[4];

/// viewport: texels along its sides.
vec4 clip_position_of_vertex(vec2 viewport) {
  Floats positions = Floats(packUint2x32(geometry.xy));
  uint at = gl_VertexIndex * geometry.z;
  vec3 p = vec3(positions.v[at], positions.v[at + 1], positions.v[at + 2]);
  precise vec3 r = vec3(dot(row0.xyz, p), dot(row1.xyz, p), dot(row2.xyz, p)) + vec3(row0.w, row1.w, row2.w);
  vec4 clip = vec4(on_grid(dot(x_row.xyz, r), plane.z) + plane.x, on_grid(dot(y_row.xyz, r), plane.z) + plane.y,
                   dot(z_row.xyz, r) + z_row.w, dot(w_row.xyz, r) + w_row.w);
  float resolution = x_row.w;
  float side = clip.w * (1.0 + 2.0 / resolution);
  gl_ClipDistance[0] = side - clip.x;
  gl_ClipDistance[1] = side + clip.x;
  gl_ClipDistance[2] = side - clip.y;
  gl_ClipDistance[3] = side + clip.y;
  clip.xy = (clip.xy + clip.w) * (resolution / viewport) - clip.w;
  return clip;
}

vec2 uv_of_vertex() {
  Floats uvs = Floats(packUint2x32(texture_coordinates.xy));
  uint at = gl_VertexIndex * texture_coordinates.z;
  return vec2(uvs.v[at], uvs.v[at + 1]);
}
