// Structs that the host's C++ and GLSL share, in scalar layout. Addresses are 64-bit; names tell spaces and units.
#ifndef APP_HOST_SHARED_H
#define APP_HOST_SHARED_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace app::gpu {
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
#endif

// Descriptor sets. The third is umbrage's own: UMBRAGE_SET.
const uint SetTextures = 0;
const uint SetTargets = 1;
const uint SetUmbrage = 2;

const uint NoTexture = 0xffffffffu;

/// uv' = u_axis * u + v_axis * v + offset.
struct GpuTexture {
  uint slot;  // In the array of textures, or NoTexture.
  uint uv_set;
  vec2 u_axis, v_axis, offset;
};

const uint MaterialUnlit = 1u;

// What a surface reads besides positions, normals and factors. Shaders of surfaces that read less leave the rest out.
const uint ReadsBaseColorTexture = 1u;
const uint ReadsMetallicRoughnessTexture = 2u;
const uint ReadsNormalTexture = 4u;
const uint ReadsEmissiveTexture = 8u;
const uint ReadsVertexColors = 16u;
const uint ReadsTextures = 15u;
const uint ReadsAll = 31u;

struct GpuMaterial {
  vec4 base_color;
  vec3 emissive;
  float metallic;
  float roughness;
  float normal_scale;
  float alpha_cutoff;
  uint flags;
  GpuTexture base_color_texture, metallic_roughness_texture, normal_texture, emissive_texture;
};

/// Vertex streams by address, tightly packed; 0 = none. Positions and normals come with the instance.
struct GpuPrimitive {
  uint64_t tangents, uv_0, uv_1, colors;
  uint material;
  uint padding;
};

struct GpuInstance {
  vec4 world_from_mesh[3];  // Rows.
  uint64_t positions, normals;  // vec3 each: the primitive's, or this instance's own after deformation.
  uint primitive;
  uint deformed;  // Its tangents do not follow: the shader derives them.
};

const uint LightPoint = 0u;
const uint LightSpot = 1u;
const uint LightDirectional = 2u;

struct GpuLight {
  vec3 position_ws;
  uint type;
  vec3 direction_ws;  // Where it shines, unit length.
  float range_m;
  vec3 intensity;  // Colour times candela, or lux when directional.
  float cos_inner;
  float cos_outer;
  uint faces;  // As umbrage::LightDesc::faces.
};

/// What the passes leave behind for one frame.
struct GpuCounters {
  uint lighting_computations_low, lighting_computations_high;
  uint most_lights_of_a_pixel;
  float exposure;
  uint box_vertices, box_instances, box_first_vertex, box_first_instance;  // VkDrawIndirectCommand
  uint box_draws;
  uint luminance_histogram[256];
};

/// The camera and everything else that a pass of this frame reads.
struct GpuFrame {
  mat4 clip_from_offset;  // From world positions relative to the eye.
  vec3 eye_ws;
  vec3 right_ws, up_ws, back_ws;
  uint orthographic;
  vec2 lens_scale;  // clip.xy = lens_scale * view.xy; y of the scale is negative.
  vec4 lens_depth;  // (a, b, c, d): depth = (a z + b) / (d - c z) with z along back_ws.
  uint width, height;
  vec3 ambient;     // Irradiance from everywhere, linear.
  vec2 shown_depth_m;  // Range of the depth picture.
  uint light_count;
  uint padding;
  vec4 mirror_ball;  // Middle and radius, world; radius 0: none.
  uint64_t instances, primitives, materials, lights, counters;
  uint64_t umbrage;
};

/// What the faces of the reflection cube map are lit with.
struct GpuReflection {
  uint64_t frame;
  uint64_t shadows[6];  // umbrage's frame of each face
  vec3 eye_ws;
  uint padding;
};

/// What a debug picture is about, chosen on the device. Counts per light (GpuLightUse) follow it.
struct GpuSubject {
  uint light;         // Host index, or NoLight.
  uint slot;          // umbrage's.
  uint clusters;      // That list the light.
  vec3 light_ws;
  vec3 box_low, box_high;  // Of the cluster under the picture's centre; low > high: there is none.
};

struct GpuLightUse {
  uint clusters, slot;
};

const uint NoLight = 0xffffffffu;

/// Push constants of the passes that need no more than the frame and a few numbers.
struct FramePush {
  uint64_t frame;
  uint64_t output_buffer;   // read_*: where the result goes.
  uint64_t output_band;     // read_visibility: likewise for band_px; 0 = not wanted.
  uint first, count;        // read_visibility: lights; read_surface: first = 0 positions, 1 normals.
  uint64_t looked_up;       // read_visibility: a bit for each texel of the pool; 0 = not wanted.
};

/// Push constants of debug pictures.
struct ShowPush {
  uint64_t frame, subject;
  uint show;                // ShowClusters …
  uint light;               // Host index of the light asked for, or NoLight: the brightest.
  uint title[16];           // Characters, the first in the low byte; 0 ends it.
};

const uint ShowClusters = 1u;
const uint ShowExplicitBounds = 2u;
const uint ShowLightsPerPixel = 3u;
const uint ShowNormals = 4u;
const uint ShowDepth = 5u;
const uint ShowResolution = 6u;
const uint ShowTexelsPerPixel = 7u;
const uint ShowPages = 8u;
const uint ShowProjectionMaps = 9u;
const uint ShowCubeProjection = 10u;
const uint ShowTriangles = 11u;
const uint ShowCascades = 12u;

/// Morph, then skin, one thread a vertex.
struct DeformPush {
  uint64_t positions, normals;            // vec3[vertex_count]
  uint64_t joints, joint_weights;         // 4 x 16 bit, vec4; 0 = no skin
  uint64_t joint_matrices;                // mat4 per joint, world from mesh
  uint64_t morph_positions, morph_normals;// vec3[target_count][vertex_count], 0 = none
  uint64_t morph_weights;                 // float[target_count]
  uint64_t out_positions, out_normals;
  uint vertex_count, target_count;
};

#ifdef __cplusplus
static_assert(sizeof(GpuTexture) == 32 && sizeof(GpuMaterial) == 176 && sizeof(GpuPrimitive) == 40);
static_assert(sizeof(GpuInstance) == 72 && sizeof(GpuLight) == 56 && sizeof(GpuCounters) == 36 + 4 * 256);
static_assert(offsetof(GpuFrame, instances) == 192 && sizeof(GpuFrame) == 240 && sizeof(GpuReflection) == 72);
static_assert(sizeof(FramePush) == 40 && sizeof(ShowPush) == 88 && sizeof(DeformPush) == 88);
static_assert(sizeof(GpuSubject) == 48 && sizeof(GpuLightUse) == 8);
}  // namespace app::gpu
#endif
#endif
