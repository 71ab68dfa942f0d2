#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Loss of acuity in dim light, after Ward Larson, Rushmeier and Piatko 1997: luminance is blurred as far as an eye adapted to
// the degree about a pixel cannot resolve, by blending two levels of the pyramid. What is lost of a pixel's luminance dims its
// colour; what is gained from neighbours is grey.

#include "shared/luminance.h"
#include "shared/photometry.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D scene_image;
layout(binding = 1, rgba32f) readonly uniform image2D foveal_level;
layout(binding = 2, rgba32f) readonly uniform image2D level_1;
layout(binding = 3, rgba32f) readonly uniform image2D level_2;
layout(binding = 4, rgba32f) readonly uniform image2D level_3;
layout(binding = 5, rgba32f) readonly uniform image2D level_4;
layout(binding = 6, rgba32f) readonly uniform image2D level_5;
layout(binding = 7, rgba32f) writeonly uniform image2D seen_image;
layout(push_constant, scalar) uniform Push { AcuityPush push; };

// Where the pixel lies on a level: the texel to the top left, and how far beyond its middle; within the level.
struct Place {
    ivec2 base, next;
    vec2 part;
};

Place place_of(uvec2 at, uint level) {
    const vec2 last = vec2((push.size + (1u << level) - 1u) >> level) - 1.0;
    const vec2 position = clamp((vec2(at) + 0.5) / float(1u << level) - 0.5, vec2(0.0), last);
    const vec2 base = floor(position);
    return Place(ivec2(base), ivec2(min(base + 1.0, last)), position - base);
}

#define BILINEAR(image, place)                                                                                        \
    mix(mix(imageLoad(image, place.base).r, imageLoad(image, ivec2(place.next.x, place.base.y)).r, place.part.x),      \
        mix(imageLoad(image, ivec2(place.base.x, place.next.y)).r, imageLoad(image, place.next).r, place.part.x), place.part.y)

// Highest frequency that is seen, cycles per degree.
float acuity(float luminance) { return 17.25 * atan(1.4 * log(max(luminance, kLuminanceFloor)) / 2.302585093 + 0.35) + 25.72; }

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;
    vec3 rgb = imageLoad(scene_image, ivec2(at)).rgb;
    const float luminance = dot(rgb, vec3(kRed, kGreen, kBlue));
    const Place about = place_of(at, push.foveal_level);
    const float footprint = 1.4142135624 * push.pixels_per_degree / acuity(BILINEAR(foveal_level, about));  // px
    const float level = clamp(log2(max(footprint, 1.0)), 0.0, float(push.levels));
    if (level > 0.0 && abs(luminance) <= 3.4e38) {
        // Weights of the levels: a tent about `level`.
        float seen = max(1.0 - level, 0.0) * luminance;
        float weight = max(1.0 - abs(level - 1.0), 0.0);
        if (weight > 0.0) { const Place p = place_of(at, 1u); seen += weight * BILINEAR(level_1, p); }
        weight = max(1.0 - abs(level - 2.0), 0.0);
        if (weight > 0.0) { const Place p = place_of(at, 2u); seen += weight * BILINEAR(level_2, p); }
        weight = max(1.0 - abs(level - 3.0), 0.0);
        if (weight > 0.0) { const Place p = place_of(at, 3u); seen += weight * BILINEAR(level_3, p); }
        weight = max(1.0 - abs(level - 4.0), 0.0);
        if (weight > 0.0) { const Place p = place_of(at, 4u); seen += weight * BILINEAR(level_4, p); }
        weight = max(1.0 - abs(level - 5.0), 0.0);
        if (weight > 0.0) { const Place p = place_of(at, 5u); seen += weight * BILINEAR(level_5, p); }
        rgb = seen < luminance ? rgb * (seen / luminance) : rgb + (seen - luminance);
    }
    imageStore(seen_image, ivec2(at), vec4(rgb, 1.0));
}
