#version 460
// Colours the lines of draw_lines.vert; fainter where the scene is in front of them.
#extension GL_GOOGLE_include_directive : require
#include "host.glsl"
#include "targets.glsl"
layout(location = 0) in vec4 color;
layout(location = 1) noperspective in float line_depth;
layout(location = 0) out vec4 out_color;
void main() {
  bool hidden = line_depth * 1.004 < texelFetch(depth_target, ivec2(gl_FragCoord.xy), 0).x;
  float alpha = color.a * (hidden ? 0.4 : 1.0);
  out_color = vec4(color.rgb * alpha, alpha);
}
