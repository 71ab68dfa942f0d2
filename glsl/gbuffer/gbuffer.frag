#version 460
#extension GL_GOOGLE_include_directive : require

// G-buffer, fragments: the surface seen by each pixel. Variants without some texture never sample it.

#include "normal.glsl"
#include "shared/gbuffer.h"

layout(constant_id = 0) const uint kBaseTexture = 1u;
layout(constant_id = 1) const uint kMetallicRoughnessTexture = 1u;
layout(constant_id = 2) const uint kEmissionTexture = 1u;
layout(constant_id = 3) const uint kMask = 0u;
// Textures that are magnified without interpolation, a bit each in their order.
layout(constant_id = 4) const uint kNearest = 0u;

layout(location = 0) in vec3 view_normal;
layout(location = 1) in vec2 texture_uv;
layout(location = 2) in vec4 base_colour;
layout(location = 3) flat in vec4 emission_cutoff;
layout(location = 4) flat in vec2 metallic_roughness;
layout(location = 5) flat in uvec2 triangle;
layout(location = 6) in vec2 emission_uv;

layout(binding = 0) uniform sampler2D base_texture;                // linear reflectance, opacity
layout(binding = 1) uniform sampler2D metallic_roughness_texture;  // green roughness, blue metallic
layout(binding = 2) uniform sampler2D emission_texture;            // linear

layout(location = 0) out vec4 out_reflectance;
layout(location = 1) out vec4 out_surface;
layout(location = 2) out vec4 out_emission;
layout(location = 3) out uvec2 out_triangle;
layout(location = 4) out uint out_slope;

// The nearest halves: a device may cut off instead when it writes them, which takes 0.03 % of every reflectance.
vec3 halves(vec3 v) { return vec3(unpackHalf2x16(packHalf2x16(v.rg)), unpackHalf2x16(packHalf2x16(v.bb)).x); }

// mix(), with the bits of `low` and `high` at 0 and 1: devices may have low + (high - low) * t, which takes from a dark texel
// beside a lamp what rounding of the lamp's luminance leaves.
vec4 between(vec4 low, vec4 high, float t) { return low * (1.0 - t) + high * t; }

// Of texels larger than a pixel the mean over a box about as wide as the pixel: borders between them are no stairs.
vec4 texture_at(sampler2D image, uint number, vec2 uv) {
    if ((kNearest >> number & 1u) == 0u) return texture(image, uv);
    const vec2 size = vec2(textureSize(image, 0)), place = uv * size, right = dFdx(place), down = dFdy(place);
    const vec2 width = sqrt(right * right + down * down);  // of the pixel, texels
    // A texel within 1/256 px of a border of the pixel is not in it: its luminance may be a million times the others'.
    const vec2 border = round(place), share = clamp(258.0 / 256.0 * (place - border) / max(width, 1e-6) + 0.5, 0.0, 1.0);
    const vec2 beyond = mix(share, step(border, place), lessThan(width, vec2(1e-4)));
    const vec2 low = (border - 0.5) / size, high = (border + 0.5) / size;
    const vec4 above = between(textureLod(image, low, 0.0), textureLod(image, vec2(high.x, low.y), 0.0), beyond.x);
    const vec4 below = between(textureLod(image, vec2(low.x, high.y), 0.0), textureLod(image, high, 0.0), beyond.x);
    const vec4 farther = texture(image, uv);
    return all(lessThan(width, vec2(1.0))) ? between(above, below, beyond.y) : farther;
}

void main() {
    // Before any invocation is discarded.
    const vec2 change = vec2(dFdx(gl_FragCoord.w), dFdy(gl_FragCoord.w)) / gl_FragCoord.w;
    const uint slope = packHalf2x16(clamp(kSlopeScale * change, -6e4, 6e4));
    vec4 base = base_colour;
    if (kBaseTexture != 0u) base *= texture_at(base_texture, 0u, texture_uv);
    // Holes of a magnified texture begin at borders of texels, whatever part of a pixel these cover.
    const bool sharp = kMask != 0u && kBaseTexture != 0u && (kNearest & 1u) != 0u;
    const float opacity = sharp ? base_colour.a * texture(base_texture, texture_uv).a : base.a;
    if (kMask != 0u && opacity < emission_cutoff.a) discard;

    vec2 m = metallic_roughness;
    if (kMetallicRoughnessTexture != 0u) m *= texture_at(metallic_roughness_texture, 1u, texture_uv).bg;
    vec3 emission = emission_cutoff.rgb;
    if (kEmissionTexture != 0u) emission *= texture_at(emission_texture, 2u, emission_uv).rgb;

    const vec3 normal = normalize(gl_FrontFacing ? view_normal : -view_normal);
    out_reflectance = vec4(halves(base.rgb), m.x);
    out_surface = vec4(encode_normal(normal), 1.0 / gl_FragCoord.w, m.y);
    out_emission = vec4(emission, 1.0);
    out_triangle = triangle;
    out_slope = slope;
}
