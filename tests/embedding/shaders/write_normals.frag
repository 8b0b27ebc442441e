// The normal as the host reads it, and once more in the encoding that umbrage is told of.
#version 460
layout(constant_id = 0) const uint encoding = 0u;  // umbrage::NormalEncoding
layout(location = 0) flat in vec3 normal_ws;
layout(location = 0) out vec4 plain;
layout(location = 1) out vec4 encoded;

void main() {
  plain = vec4(normal_ws, 0.0);
  vec2 folded = normal_ws.xy / (abs(normal_ws.x) + abs(normal_ws.y) + abs(normal_ws.z));
  vec2 signs = vec2(folded.x >= 0.0 ? 1.0 : -1.0, folded.y >= 0.0 ? 1.0 : -1.0);
  if (normal_ws.z < 0.0) folded = (1.0 - abs(folded.yx)) * signs;
  encoded = vec4(0.0);
  if (encoding == 1u) encoded.xy = folded;
  if (encoding == 2u) encoded.xyz = 0.5 * normal_ws + 0.5;
  if (encoding == 3u) encoded.xyz = normal_ws;
}
