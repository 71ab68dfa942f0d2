#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// How much light each square of the picture has, where its middle is, and how far it spreads. Pixels that are not finite have none.

#include "shared/corona.h"
#include "shared/photometry.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D scene;
layout(binding = 1, scalar) writeonly buffer Tiles { CoronaTile tiles[]; };
layout(push_constant, scalar) uniform Push { CoronaPush push; };

void main() {
    const uvec2 columns_rows = (push.size + kCoronaTile - 1u) / kCoronaTile;
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= columns_rows.x) return;
    const uvec2 first = at * kCoronaTile, end = min(first + kCoronaTile, push.size);
    const vec2 middle = vec2(first) + 0.5 * float(kCoronaTile);
    vec3 light = vec3(0.0);
    vec4 moments = vec4(0.0);  // of luminance: 1, x, y, x^2 + y^2, from the middle
    for (uint y = first.y; y < end.y; ++y)
        for (uint x = first.x; x < end.x; ++x) {
            vec3 rgb = imageLoad(scene, ivec2(x, y)).rgb;
            if (!(abs(rgb.r + rgb.g + rgb.b) <= 3.4e38)) continue;
            rgb = max(rgb, vec3(0.0));
            const vec2 away = vec2(x, y) + 0.5 - middle;
            light += rgb;
            moments += dot(rgb, vec3(kRed, kGreen, kBlue)) * vec4(1.0, away, dot(away, away));
        }
    CoronaTile tile = CoronaTile(vec3(0.0), 0.0, middle, 0.0);
    if (moments.x > 0.0 && moments.w <= 3.4e38) {
        const vec2 mean = moments.yz / moments.x;
        tile = CoronaTile(light, moments.x, middle + mean, max(0.5 * (moments.w / moments.x - dot(mean, mean)), 0.0));
    }
    tiles[at.y * columns_rows.x + at.x] = tile;
}
