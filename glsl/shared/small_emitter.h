// Emitting surfaces that are about as small as a pixel, as seen by one eye. SPDX-License-Identifier: MIT
#ifndef VESPER_SHARED_SMALL_EMITTER_H
#define VESPER_SHARED_SMALL_EMITTER_H
#include "types.h"
SHARED_BEGIN

// A triangle that emits, or a facet that hides those that do: its silhouette. Read as a texel buffer of three rgba32f texels.
struct SmallEmitter {
    vec3 luminance;      // cd/m^2 RGB, of what the silhouette covers
    float first;         // of its vertices
    vec3 inverse_depth;  // of its plane, 1/m, at a place: dot(inverse_depth, vec3(px from the origin, 1))
    float vertices;      // how many
    vec2 origin;         // px, whole: vertices count from here
    float hides;         // 1: it emits nothing, but hides what is behind it
    float unused;
};
SHARED_SIZE(SmallEmitter, 48)

const uint kTexelsPerSmallEmitter = 3u;

// What is nearer than an emitter by so much of its depth hides it: rounding does not.
const float kInFront = 1e-5f;

struct SmallEmittersPush {
    uvec2 size;       // px
    vec2 ray_scale;   // as in EdgesPush
    vec2 ray_offset;
    uint tiles;       // (column, row, first entry, entries) each
};
SHARED_SIZE(SmallEmittersPush, 28)

SHARED_END
#endif
