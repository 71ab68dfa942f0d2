// Emitting surfaces that are about as small as a pixel, as seen by one eye. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SMALL_EMITTER_H
#define VESPER_SHARED_SMALL_EMITTER_H
#include "types.h"
SHARED_BEGIN

// A triangle that emits, or a facet that hides those that do: its silhouette. Read as a texel buffer of four rgba32f texels.
struct SmallEmitter {
    vec3 luminance;      // cd/m^2 RGB
    float first;         // of its vertices
    vec3 inverse_depth;  // of its plane, 1/m, at a place: dot(inverse_depth, vec3(px from the origin, 1))
    float vertices;      // how many
    vec2 origin;         // px, whole: vertices count from here
    float placement;     // as of its Instance
    float widening;      // drawn area over true area; 0: it emits nothing
    float reach;         // facets of its mesh that are less than so much before it are listed, m
    vec3 unused;
};
SHARED_SIZE(SmallEmitter, 64)

const uint kTexelsPerSmallEmitter = 4u;

// What is nearer than an emitter by so much of its depth hides it: rounding does not.
const float kInFront = 3e-6f;

struct SmallEmittersPush {
    uvec2 size;       // px
    vec2 ray_scale;   // as in EdgesPush
    vec2 ray_offset;
    uint tiles;       // (column, row, first entry, entries) each
};
SHARED_SIZE(SmallEmittersPush, 28)

SHARED_END
#endif
