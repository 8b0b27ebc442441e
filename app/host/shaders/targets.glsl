// The G-buffer as the passes after it read it, and the two pictures.
#extension GL_EXT_samplerless_texture_functions : require
layout(set = SetTargets, binding = 0) uniform texture2D depth_target;
layout(set = SetTargets, binding = 1) uniform texture2D geometric_normal_target;  // octahedral, world, facing the eye
layout(set = SetTargets, binding = 2) uniform texture2D normal_target;            // octahedral, world
layout(set = SetTargets, binding = 3) uniform texture2D base_color_target;        // a = 0: unlit
layout(set = SetTargets, binding = 4) uniform texture2D metal_rough_target;
layout(set = SetTargets, binding = 5) uniform texture2D emissive_target;
layout(set = SetTargets, binding = 6, rgba32f) uniform image2D color_target;      // premultiplied, a = coverage
layout(set = SetTargets, binding = 7, rgba8) uniform image2D picture_target;      // sRGB-encoded
