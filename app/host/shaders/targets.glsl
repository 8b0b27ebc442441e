// The G-buffer as the passes after it read it, and the two pictures.
#extension GL_EXT_samplerless_texture_functions : require
layout(set = SetTargets, binding = 0) uniform texture2D depth_target;
layout(set = SetTargets, binding = 1) uniform texture2D geometric_normal_target;  // octahedral, world, facing the eye
layout(set = SetTargets, binding = 2) uniform utexture2D surface_target;          // packed_surface.glsl
layout(set = SetTargets, binding = 3, rgba32f) uniform image2D color_target;      // premultiplied, a = coverage
layout(set = SetTargets, binding = 4, rgba8) uniform image2D picture_target;      // sRGB-encoded
