#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require

// Visibility of directional lamps from pixels: one block per workgroup, and one column of pixels per invocation. Each pixel
// looks up the middle of a lamp's disc and a point beside it; where these differ within a block, each searches casters as far
// as its penumbra may reach, and then looks up all of the disc from its own place (Fernando 2005).

#include "blocks.glsl"
#include "normal.glsl"
#include "texels.glsl"
#include "shared/clipmap.h"

layout(local_size_x = 8) in;  // kBlockSize
layout(constant_id = 0) const uint kLockstep = 0u;  // see lanes.glsl

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
TEXELS(1, vec4, maps);  // Clipmap
HALVES(2, distances);
layout(binding = 3, scalar) writeonly buffer Shares { uint shares[]; };
layout(push_constant, scalar) uniform Push { DirectionalVisibilityPush push; };

#include "lanes.glsl"
#include "shadows/lookup.glsl"

const float kWiden = 1.08;        // a level reaches at least that much less far from the eye than its half width
const float kSteepest = 100.0;    // tangent of the angle from the way of the light: the plane of a surface is taken to be no steeper
const float kLeastWidth = 0.7;    // texels, radius of the disc that a pixel looks up: edges of lamps without a size are that soft
const float kFarthest = 0.8 * kMapFar;  // m: nothing is known of surfaces farther along the light

vec3 position[kBlockSize], normal[kBlockSize];  // of the column
bool drawn[kBlockSize];

struct DirectionalLamp {
    mat3 rotation;     // from the view frame to that of the map
    vec3 way;      // of the light, view frame
    int first;
    float radius;  // tangent of half its angle
    float reach;   // m, of the widest penumbra
};

DirectionalLamp fetch_lamp(uint lamp) {
    const int at = int(lamp * kClipmapTexels);
    const vec4 b = texel_at(maps, at + 1);
    const mat3 rotation = rotation_of(texel_at(maps, at));
    return DirectionalLamp(rotation, vec3(rotation[0].z, rotation[1].z, rotation[2].z), int(b.x) * int(kMapUnit), b.y, b.y * kPenumbraReach);
}

// A surface as a level sees it.
struct LevelPoint {
    vec2 texel;    // of the square, (0, 0) in its corner
    vec3 plane;    // the distance of the surface's plane is plane.xy . texel + plane.z, m
    float bias;    // m
    float width;   // of a texel, m
    int first;     // texel of the level
    bool inside;
};

LevelPoint level_point(DirectionalLamp lamp, uint number, vec3 p, vec3 n) {
    const vec3 q = lamp.rotation * p, m = lamp.rotation * n;
    const float wide = kWiden * (max(abs(q.x), abs(q.y)) + lamp.reach);
    const int level = clamp(int(ceil(log2(max(wide / kFirstHalfWidth, 1.0)))), 0, int(push.levels) - 1);
    const vec3 from = q - texel_at(maps, int(number * kClipmapTexels) + 2 + level).xyz;
    const float half_width = kFirstHalfWidth * exp2(float(level)), side = float(push.side), width = 2.0 * half_width / side;
    const vec2 texel = 0.5 * side + from.xy / width;
    const bool inside = all(greaterThanEqual(texel, vec2(1.0))) && all(lessThanEqual(texel, vec2(side - 1.0))) && from.z < kFarthest;
    const vec2 slope = m.z != 0.0 ? clamp(-m.xy / m.z, vec2(-kSteepest), vec2(kSteepest)) * width : vec2(0.0);
    return LevelPoint(texel, vec3(slope, from.z - dot(slope, texel)), kMapBias + 0.5 * width + kMapRounding * abs(from.z), width,
                      lamp.first + level * int(push.side * push.side), inside);
}

// How much farther the surface is than what the lamp sees along the middle of a texel, m; above 0 it is hidden.
float depth_below(LevelPoint p, vec2 offset) {
    const ivec2 at = clamp(ivec2(floor(p.texel + offset)), ivec2(0), ivec2(push.side - 1u));
    const float seen = half_at(distances, p.first + at.y * int(push.side) + at.x);
    return dot(p.plane.xy, vec2(at) + 0.5) + p.plane.z - seen - p.bias;
}

// The widest penumbra, texels.
float reach_of(DirectionalLamp lamp, LevelPoint p) { return max(lamp.reach / p.width, kLeastWidth); }

// Where the k-th of kDisc lookups searches, in lengths of the widest penumbra: most of them near the middle, since what is close
// to the surface has narrow ones.
vec2 search_point(uint k) {
    const float u = (float(k) + 0.5) / float(kDisc);
    return u * sqrt(u) * disc_point(k);
}

// Share of the lamp that a point sees, in 255ths. Where a row of pixels finds nothing that hides it the search is all.
uint share_of_disc(DirectionalLamp lamp, LevelPoint p) {
    const float reach = reach_of(lamp, p);
    float below = 0.0;
    uint hidden = 0u;
    for (uint k = 0u; k < kDisc; ++k) {
        const float depth = depth_below(p, reach * search_point(k));
        below += max(depth, 0.0);
        hidden += depth > 0.0 ? 1u : 0u;
    }
    const float depth_here = depth_below(p, vec2(0.0));
    const bool here = depth_here > 0.0;
    below += max(depth_here, 0.0);
    hidden += here ? 1u : 0u;
    uint share = 255u;
    const bool partly = lanes_any(p.inside && hidden > 0u);
    if (partly) {
        const float width = clamp(lamp.radius / p.width * below / max(float(hidden), 1.0), kLeastWidth, reach);
        uint seen = 0u;
        for (uint k = 0u; k < kDisc; ++k) seen += depth_below(p, width * disc_point(k)) > 0.0 ? 0u : 1u;
        share = (seen * 255u + kDisc / 2u) / kDisc;
    }
    return p.inside ? share : 255u;
}

// Shares of the column, 8 bits at a shift each.
void look_up(uint number, inout uint words[kBlockSize]) {
    const DirectionalLamp lamp = fetch_lamp(number);
    const uint lane = gl_LocalInvocationID.x, shift = 8u * (number % kSharesPerWord);
    bool any_seen = false, any_hidden = false;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const LevelPoint p = level_point(lamp, number, position[r], normal[r]);
        const vec2 beside = reach_of(lamp, p) * search_point(r % 4u * 8u + (r < 4u ? lane : 7u - lane));  // all in every four rows
        const bool here = depth_below(p, vec2(0.0)) > 0.0, there = depth_below(p, beside) > 0.0;
        const bool faces = drawn[r] && dot(normal[r], lamp.way) < 0.0;
        any_seen = any_seen || (faces && (!p.inside || !here || !there));
        any_hidden = any_hidden || (faces && p.inside && (here || there));
    }
    any_seen = lanes_any(any_seen);
    any_hidden = lanes_any(any_hidden);
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) words[r] |= (any_hidden ? 0u : 255u) << shift;
    if (any_seen && any_hidden)
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r)
            words[r] |= share_of_disc(lamp, level_point(lamp, number, position[r], normal[r])) << shift;
}

void main() {
    const uvec2 corner = gl_WorkGroupID.xy * kBlockSize;
    const uint lane = gl_LocalInvocationID.x, block = gl_WorkGroupID.y * push.blocks_x + gl_WorkGroupID.x;
    [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) {
        const uvec2 pixel = corner + uvec2(lane, r);
        const vec4 surface = imageLoad(surface_image, ivec2(min(pixel, push.size - 1u)));
        drawn[r] = surface.z > 0.0 && all(lessThan(pixel, push.size));
        position[r] = pixel_ray(push.grid, vec2(pixel)) * surface.z;
        normal[r] = decode_normal(surface.xy);
    }
    const uint count = (push.lamps + kSharesPerWord - 1u) / kSharesPerWord;
    for (uint w = 0u; w < count; ++w) {
        uint words[kBlockSize];
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) words[r] = 0u;
        for (uint i = w * kSharesPerWord; i < min(push.lamps, (w + 1u) * kSharesPerWord); ++i) look_up(i, words);
        const int at = int(((block * count + w) * kBlockSize) * kBlockSize + lane);
        [[unroll]] for (uint r = 0u; r < kBlockSize; ++r) shares[at + int(r * kBlockSize)] = words[r];
    }
}
