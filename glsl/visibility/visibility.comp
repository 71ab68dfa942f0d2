#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Visibility of lamps from blocks of pixels, one block per invocation. Of the lamps on a block's list, those that nothing
// of the block sees leave it, and those that some of it may not see are marked (kMixedBit). What a surface sees of a lamp
// changes at edges of the lamp's distance map alone: where the part of the map that a block covers has none, one look
// tells for all of a plane; where it has some, looks at every texel of that part do. For other surfaces sixteen of the
// block's pixels speak for all.

#include "blocks.glsl"
#include "normal.glsl"
#include "shared/visibility.h"

layout(local_size_x = 8) in;

layout(binding = 0, rgba32f) readonly uniform image2D surface_image;
layout(binding = 1) uniform samplerBuffer lamps;
layout(binding = 2, r32ui) uniform uimageBuffer block_counts;
layout(binding = 3, r32ui) uniform uimageBuffer entries;
layout(binding = 4) uniform samplerBuffer maps;
layout(binding = 5) uniform samplerBuffer distances;
layout(binding = 6) uniform samplerBuffer bounds;  // halves: least distance, negative at edges; greatest
layout(binding = 7, r32ui) uniform uimageBuffer report;
layout(push_constant, scalar) uniform Push { VisibilityPush push; };

#include "visibility.glsl"

const uint kProbes = 16u;
const int kMostGroups = 16, kMostTexels = 144;
const float kMostTilt = 1e-3, kMostLift = 1e-3;  // of a plane's pixels: rad; and of their distance from the eye

vec3 probe_position[kProbes], probe_normal[kProbes];  // pixels of the block; the first ones are repeated where nothing is drawn
vec3 corners[4];  // of a plane
bool plane;       // all of the block's surfaces are one

void look_at_block(uvec2 corner) {
    const uvec2 end = min(corner + kBlockSize, push.size);
    vec3 normal = vec3(0.0, 0.0, 1.0), place = vec3(0.0);
    bool drawn = false;
    float away = 0.0;
    plane = true;
    for (uint y = corner.y; y < end.y; ++y)
        for (uint x = corner.x; x < end.x; ++x) {
            const vec4 surface = imageLoad(surface_image, ivec2(x, y));
            const bool here = surface.z > 0.0, first = here && !drawn;
            const vec3 n = decode_normal(surface.xy), position = pixel_ray(push.grid, vec2(x, y)) * surface.z;
            drawn = drawn || here;
            normal = first ? n : normal;
            place = first ? position : place;
            away = first ? dot(n, position) : away;
            plane = plane && (!here || (distance(n, normal) <= kMostTilt && abs(dot(normal, position) - away) <= kMostLift * surface.z));
        }
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        const vec3 ray = pixel_ray(push.grid, vec2(k % 2u == 0u ? corner.x : end.x - 1u, k < 2u ? corner.y : end.y - 1u));
        const float depth = away / dot(normal, ray);
        plane = plane && depth > 0.0 && depth < 1e6;
        corners[k] = ray * depth;
    }
    [[unroll]] for (uint k = 0u; k < kProbes; ++k) {
        const uvec2 at = corner + uvec2(k % 4u, k / 4u) * 2u + uvec2(k / 4u % 2u, k % 2u);
        const vec4 surface = imageLoad(surface_image, ivec2(min(at, push.size - 1u)));
        const bool here = surface.z > 0.0 && all(lessThan(at, end));
        probe_position[k] = here ? pixel_ray(push.grid, vec2(at)) * surface.z : place;
        probe_normal[k] = here ? decode_normal(surface.xy) : normal;
    }
}

const uint kLit = 0u, kDark = 1u, kMixed = 2u;

vec2 low_texel, high_texel;  // of a map: the part that the block covers
bool within;                 // the map has all of it
bool bends;                  // it crosses the border of a quadrant

// The corners of a plane. Within a quadrant of the map they bound what is between them; across its borders straight lines
// bend.
void cover_plane(FetchedMap map, vec3 lamp) {
    low_texel = vec2(1e30), high_texel = vec2(-1e30), within = true;
    bvec4 sides = bvec4(false);
    int hemisphere = 0;
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        const MapPoint p = map_point(map, corners[k] - lamp, probe_normal[0]);
        const vec2 square = p.texel - 0.5 * float(map.side);
        const float x = square.x + square.y, y = square.x - square.y;
        sides = bvec4(sides.x || x < 0.0, sides.y || x > 0.0, sides.z || y < 0.0, sides.w || y > 0.0);
        low_texel = min(low_texel, p.texel);
        high_texel = max(high_texel, p.texel);
        hemisphere = k == 0u ? p.first : hemisphere;
        within = within && p.inside && p.first == hemisphere;
    }
    bends = (sides.x && sides.y) || (sides.z && sides.w);
    const vec2 more = bends ? 0.5 * (high_texel - low_texel) : vec2(0.0);
    low_texel -= more, high_texel += more;
}

// Pixels of a surface of any shape.
uint probe(FetchedMap map, vec3 lamp) {
    uint seen = 0u;
    for (uint k = 0u; k < kProbes && (seen == k || seen == 0u); ++k) {
        const MapPoint p = map_point(map, probe_position[k] - lamp, probe_normal[k]);
        seen += !p.inside || sees(map, p, ivec2(floor(p.texel))) ? 1u : 0u;
    }
    return seen == kProbes ? kLit : seen == 0u ? kDark : kMixed;
}

uint visibility_of(uint lamp) {
    const FetchedMap map = fetch_map(lamp);
    if (map.side == 0) return kLit;
    const vec3 position = texelFetch(lamps, int(lamp * kTexelsPerLamp)).xyz;
    if (!plane) return probe(map, position);
    cover_plane(map, position);
    const MapPoint p = map_point(map, probe_position[0] - position, probe_normal[0]);
    const float margin = 1.0;  // texels that a look takes besides
    const vec2 low = low_texel - margin, high = high_texel + margin;
    if (!within || any(lessThan(low, vec2(0.0))) || any(greaterThanEqual(high, vec2(map.side)))) return kMixed;
    // The lowest level at which few groups cover it.
    ivec2 from, to;
    uint level = 0u;
    for (; level < kBoundLevels; ++level) {
        from = ivec2(low) >> int(level + 2u), to = ivec2(high) >> int(level + 2u);
        if ((to.x - from.x + 1) * (to.y - from.y + 1) <= kMostGroups) break;
    }
    if (level == kBoundLevels) return kMixed;
    const int row = map.side >> int(level + 2u);
    const int base = p.first / 8 + (map.side * map.side - (map.side >> int(level)) * (map.side >> int(level))) / 12;
    bool edge = false;
    for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
            edge = edge || texelFetch(bounds, base + y * row + x).x < 0.0;
        }
    if (!edge) return sees(map, p, ivec2(floor(p.texel))) ? kLit : kDark;
    // Not every edge is one of a shadow: it may be beside it, or behind the plane.
    const ivec2 first = ivec2(floor(low_texel - 0.5)), last = ivec2(floor(high_texel - 0.5)) + 1;
    const int width = last.x - first.x + 1, count = width * (last.y - first.y + 1);
    if (bends || count > kMostTexels) return kMixed;
    int seen = 0;
    for (int i = 0; i < count && (seen == i || seen == 0); ++i) seen += sees(map, p, first + ivec2(i % width, i / width)) ? 1 : 0;
    return seen == count ? kLit : seen == 0 ? kDark : kMixed;
}

uint lit = 0u, dark = 0u, mixed = 0u;

// Looks at entries from `first` on, every `step`-th. Returns how many are left.
uint keep_visible(uint count, int first, int step_) {
    int kept = 0;
    for (int i = 0; i < int(count); ++i) {
        const uint entry = imageLoad(entries, first + step_ * i).r;
        const uint visible = visibility_of(lamp_of(entry));
        lit += visible == kLit ? 1u : 0u;
        dark += visible == kDark ? 1u : 0u;
        mixed += visible == kMixed ? 1u : 0u;
        if (visible == kDark) continue;
        imageStore(entries, first + step_ * kept, uvec4(visible == kMixed ? entry | kMixedBit : entry));
        ++kept;
    }
    return uint(kept);
}

void main() {
    const uint even_rows = (push.blocks_y + 1u) / 2u, turn = gl_WorkGroupID.y;  // as in merge_lamps
    const uint y = turn < even_rows ? 2u * turn : 2u * (turn - even_rows) + 1u, x = gl_GlobalInvocationID.x;
    if (x >= push.blocks_x) return;
    const uint block = y * push.blocks_x + x;
    const int counts = int(2u * block), first = int(block * push.capacity);
    const uint cones = imageLoad(block_counts, counts).r, others = imageLoad(block_counts, counts + 1).r;
    if (cones == kAllLamps || cones + others == 0u) return;
    look_at_block(uvec2(x, y) * kBlockSize);
    const uint kept_cones = keep_visible(cones, first, 1), kept_others = keep_visible(others, first + int(push.capacity) - 1, -1);
    imageStore(block_counts, counts, uvec4(kept_cones));
    imageStore(block_counts, counts + 1, uvec4(kept_others));
    imageAtomicAdd(report, 0, lit);
    imageAtomicAdd(report, 1, dark);
    imageAtomicAdd(report, 2, mixed);
}
