#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Light scattered in the eye, near the border: each pixel keeps some more of its own, or less, so that what all of the picture has
// of its light is right. One pixel an invocation: first those above and below, then those at the sides.

#include "texels.glsl"
#include "shared/eye_scatter.h"

layout(local_size_x = 64) in;

layout(binding = 0, rgba32f) readonly uniform image2D scene;
TEXELS(1, float, kept);  // a part of the light, at places
layout(binding = 2, rgba32f) uniform image2D seen;
layout(push_constant, scalar) uniform Push { ScatterEdgePush push; };

// EdgeLight::Axis::place.
vec2 place_of(uvec2 pixel) {
    const vec2 at = vec2(pixel), deep = vec2(push.deep), middle = vec2(push.size) - 2.0 * deep + 1.0;
    return min(at, deep - 1.0) + clamp(at - (deep - 1.0), vec2(0.0), middle) * (vec2(push.between) + 1.0) / middle + max(at - (vec2(push.size) - deep), vec2(0.0));
}

void main() {
    const uint index = gl_GlobalInvocationID.x, rows = 2u * push.deep.y * push.size.x, columns = 2u * push.deep.x;
    const uint height = push.size.y - 2u * push.deep.y;
    if (index >= rows + columns * height) return;
    uvec2 pixel;
    if (index < rows) {
        pixel = uvec2(index % push.size.x, index / push.size.x);
        pixel.y += pixel.y < push.deep.y ? 0u : height;
    } else {
        const uint side = index - rows;
        pixel = uvec2(side % columns, push.deep.y + side / columns);
        pixel.x += pixel.x < push.deep.x ? 0u : push.size.x - columns;
    }
    const uvec2 places = 2u * push.deep + push.between;
    const vec2 place = place_of(pixel);
    const ivec2 first = min(ivec2(place), ivec2(places) - 1), next = min(first + 1, ivec2(places) - 1);
    const vec2 part = place - vec2(first);
    const int row = first.y * int(places.x), below = next.y * int(places.x);
    const float part_kept = mix(mix(texel_at(kept, row + first.x).r, texel_at(kept, row + next.x).r, part.x),
                                mix(texel_at(kept, below + first.x).r, texel_at(kept, below + next.x).r, part.x), part.y);
    const vec3 light = imageLoad(scene, ivec2(pixel)).rgb;
    if (!(abs(light.r + light.g + light.b) <= 3.4e38)) return;  // what is not finite stays
    const vec4 veiled = imageLoad(seen, ivec2(pixel));
    imageStore(seen, ivec2(pixel), vec4(veiled.rgb + part_kept * light, veiled.a));
}
