#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// G-buffer, fragments: the surface seen by each pixel. Variants without some texture never sample it.

#include "normal.glsl"
#include "shared/gbuffer.h"

layout(constant_id = 0) const uint kBaseTexture = 1u;
layout(constant_id = 1) const uint kMetallicRoughnessTexture = 1u;
layout(constant_id = 2) const uint kEmissionTexture = 1u;
layout(constant_id = 3) const uint kMask = 0u;
// Textures that are magnified without interpolation, a bit each in their order.
layout(constant_id = 4) const uint kNearest = 0u;
layout(constant_id = 5) const uint kRelief = 0u;  // there is a normal texture

layout(location = 0) in vec3 view_normal;
layout(location = 1) in vec2 texture_uv;
layout(location = 2) in vec4 base_colour;
layout(location = 3) flat in vec4 emission_cutoff;
layout(location = 4) flat in vec2 metallic_roughness;
layout(location = 5) flat in uvec2 triangle;
layout(location = 6) in vec2 emission_uv;

layout(push_constant, scalar) uniform Push { GBufferPush push; };  // a CPU device reads varyings faster: of reliefs only

layout(binding = 0) uniform sampler2D base_texture;                // linear reflectance, opacity
layout(binding = 1) uniform sampler2D metallic_roughness_texture;  // green roughness, blue metallic
layout(binding = 2) uniform sampler2D emission_texture;            // linear
layout(binding = 3) uniform sampler2D relief_texture;              // mean normal; root of what its length lacks to 1

layout(location = 0) out vec4 out_reflectance;
layout(location = 1) out vec4 out_surface;
layout(location = 2) out vec4 out_emission;
layout(location = 3) out uvec2 out_triangle;
layout(location = 4) out uint out_slope;

const float kLeastFacing = 0.02;  // cosine between a normal of a relief and the way to the eye

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

// Of the pixel, in the view frame, m.
vec3 view_position() { return vec3(push.ray_scale * gl_FragCoord.xy + push.ray_offset, -1.0) / gl_FragCoord.w; }

// The normal of the relief on a surface with the normal n, which the texture has along u, against v (glTF 2.0, 3.9.3: green is up in the
// picture) and along n. How place and coordinates change over the pixel says where u and v lead; the plane of a triangle has one answer.
vec3 relief_normal(vec3 n, vec3 relief) {
    const vec3 place = view_position(), right = dFdx(place), down = dFdy(place);
    const vec2 to_right = dFdx(texture_uv), to_down = dFdy(texture_uv);
    const float turn = to_right.x * to_down.y - to_down.x * to_right.y < 0.0 ? -1.0 : 1.0;
    const vec3 along_u = turn * (right * to_down.y - down * to_right.y), along_v = turn * (down * to_right.x - right * to_down.x);
    const vec3 u = along_u - n * dot(n, along_u), side = cross(n, u);
    const float size = dot(u, u);
    if (!(size > 0.0)) return n;
    return normalize(inversesqrt(size) * (relief.x * u + relief.y * (dot(side, along_v) > 0.0 ? -side : side)) + relief.z * n);
}

void main() {
    // Before any invocation is discarded.
    vec3 normal = normalize(view_normal);
    float mean_length = 1.0, spread = 0.0;  // of the normals that the pixel shows
    if (kRelief != 0u) {
        const vec4 relief = texture(relief_texture, texture_uv);
        normal = relief_normal(normal, relief.rgb);
        mean_length = clamp(length(relief.rgb), 0.0, 1.0), spread = min(relief.a * relief.a, 0.99);
    }
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

    normal = gl_FrontFacing ? normal : -normal;
    if (kRelief != 0u) {
        // A relief that is seen faces the eye.
        const vec3 toward_eye = -normalize(view_position());
        normal = normalize(normal + max(kLeastFacing - dot(normal, toward_eye), 0.0) * toward_eye);
        // Matt facets that a pixel does not resolve reflect as their mean normal, which is no unit vector (E = I n.l / d^2 is linear in n);
        // smooth ones spread the lobe by the variance of their slopes (Toksvig 2005: (1 - |n|) / |n|; of GGX alpha^2 is twice that).
        base.rgb *= mix(mean_length, 1.0, clamp(m.x, 0.0, 1.0));
        const float alpha2 = m.y * m.y * m.y * m.y + 2.0 * spread / (1.0 - spread);
        if (m.y < 1.0 && spread > 0.0) m.y = min(sqrt(sqrt(alpha2)), 0.999);
    }
    out_reflectance = vec4(halves(base.rgb), m.x);
    const float mark = kRelief != 0u ? kReliefMark : 0.0;
    out_surface = vec4(encode_normal(normal) + vec2(mark, 0.0), 1.0 / gl_FragCoord.w, m.y);
    out_emission = vec4(emission, 1.0);
    out_triangle = triangle;
    out_slope = slope;
}
