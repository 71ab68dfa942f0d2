#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Projection: the displayed light that each pixel of a projector shows, as codes.

#include "shared/projection.h"
#include "encode.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kBlueFirst = 0u;  // codes begin with blue

layout(binding = 0) uniform sampler2D light;  // displayed, in the display's primaries
layout(binding = 1, scalar) readonly buffer Pixels { ProjectedPixel pixels[]; };
layout(binding = 2) uniform samplerBuffer cells;
layout(binding = 3, r32ui) writeonly uniform uimage2D display_image;
layout(push_constant, scalar) uniform Push { ProjectionPush push; };

vec3 light_of(ivec2 at) { return texelFetch(light, clamp(at, ivec2(0), ivec2(push.picture) - 1), 0).rgb; }

// Between four pixels, with weights of full precision: a sampler's have some eight bits.
vec3 light_at(vec2 at) {
    const vec2 low = floor(at - 0.5), f = at - 0.5 - low;
    const ivec2 first = ivec2(low);
    return mix(mix(light_of(first), light_of(first + ivec2(1, 0)), f.x),
               mix(light_of(first + ivec2(0, 1)), light_of(first + ivec2(1, 1)), f.x), f.y);
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.size))) return;
    const ProjectedPixel pixel = pixels[at.y * push.size.x + at.x];
    vec3 shown = vec3(0.0);
    if (pixel.factor >= 0.0) shown = pixel.factor * light_at(pixel.at);
    const uint codes = codes_of(cells, push.encode, kBlueFirst == 0u ? shown : shown.bgr);
    imageStore(display_image, ivec2(at), uvec4(codes));
}
