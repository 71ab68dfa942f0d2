// What a batch of triangles is drawn with. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_GBUFFER_H
#define VESPER_SHARED_GBUFFER_H
#include "types.h"
SHARED_BEGIN

struct GBufferPush {
    vec4 base_colour;     // linear reflectance and opacity
    vec3 emission;        // cd/m^2 RGB
    float alpha_cutoff;   // of masked materials
    float metallic;
    float roughness;
    vec2 clip_scale;      // clip.xy = clip_scale * view.xy + clip_offset * view.z
    vec2 clip_offset;
    float near;           // depth buffer = near / depth
    vec2 ray_scale;       // a pixel at p px sees along (ray_scale * p + ray_offset, -1)
    vec2 ray_offset;
};
SHARED_SIZE(GBufferPush, 76)

// One instance of a mesh, read at instance rate.
struct Instance {
    vec4 row_x;      // rows of its model-to-view matrix
    vec4 row_y;
    vec4 row_z;
    float dimming;   // factor on its emission
    float mask;      // number of its mask (shared/masks.h); 0: no holes; -1: holes at unknown places
    float placement; // 1 + number of the mesh that it is a part of
    float unused;    // so that it is kTexelsPerInstance texels of rgba32f
};
SHARED_SIZE(Instance, 64)
const uint kTexelsPerInstance = 4u;

// The change of inverse depth with a step of a pixel, over itself, is held times this: small ones are whole halves, too.
const float kSlopeScale = 1024.0;

SHARED_END
#endif
