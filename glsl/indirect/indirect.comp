#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

// Light of emitting surfaces, of the sky, and reflected light: adds E rho lambert, E between the cells of surfaces that face the
// same.

#include "normal.glsl"
#include "sheen.glsl"
#include "texels.glsl"
#include "shared/indirect.h"
#include "shared/shade.h"

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kRows = 1u;  // pixels of a column that an invocation does
layout(constant_id = 3) const uint kMoving = 0u;  // whether there is light of what moves

layout(binding = 0, rgba16f) readonly uniform image2D reflectance_image;
layout(binding = 1, rgba32f) readonly uniform image2D surface_image;
layout(binding = 2, rgba32f) uniform image2D scene_image;
TEXELS(3, uvec4, cells);
layout(binding = 4, rgba16f) readonly uniform image2D moving_light_image;
layout(push_constant, scalar) uniform Push { IndirectPush push; };

uvec4 find(uint number) {
    const uint mask = (1u << push.log2_places) - 1u;
    uint place = (number * kCellHash) >> (32u - push.log2_places);
    uvec4 cell = texel_at(cells, int(place));
    for (uint i = 0u; i < mask && cell.x != number && cell.x != kNoCell; ++i) {
        place = (place + 1u) & mask;
        cell = texel_at(cells, int(place));
    }
    return cell;
}

// Of a cube, and what a surface in it faces, of so many; cells of air begin after those of surfaces.
uint number_of(vec3 cube, vec3 cubes, uint facing, uint facings) {
    const bool there = all(greaterThanEqual(cube, vec3(0.0))) && all(lessThan(cube, cubes));
    const uvec3 c = uvec3(cube), count = uvec3(cubes);
    return there ? ((c.z * count.y + c.y) * count.x + c.x) * facings + facing : kNoCell;
}

// The axis of a side; between two sides the first after the missing one.
uint axis_of(uint facing) {
    const uint after = (facing - kCellSides) / 4u + 1u;
    return facing < kCellSides ? facing >> 1u : after == 3u ? 0u : after;
}

uint facing_of(vec3 direction) {
    const vec3 a = vec3(kSideFactorX, kSideFactorY, kSideFactorZ) * abs(direction);
    const bvec3 backwards = lessThan(direction, vec3(0.0));
    const uint least = a.z <= a.x && a.z <= a.y ? 2u : a.y <= a.x ? 1u : 0u, most = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
    const vec2 others = least == 0u ? a.yz : least == 1u ? a.zx : a.xy;
    const bvec2 signs = least == 0u ? backwards.yz : least == 1u ? backwards.zx : backwards.xy;
    const uint between = kCellSides + 4u * least + (signs.x ? 2u : 0u) + (signs.y ? 1u : 0u);
    const bool is_backwards = most == 0u ? backwards.x : most == 1u ? backwards.y : backwards.z;
    return min(others.x, others.y) > kBetween * max(others.x, others.y) ? between : 2u * most + (is_backwards ? 1u : 0u);
}

vec3 light_of(uvec4 cell) { return kCellUnit * vec3(unpackHalf2x16(cell.y), unpackHalf2x16(cell.z).x); }

// The cells of the eight cubes whose middles are around a point, of what its surface faces. They are the same for all points
// between these middles. Cells 2 k and 2 k + 1 are the lower and the upper of a column; columns 0 and 1, 2 and 3 follow each other across
// the side.
struct Corners {
    ivec4 of;       // the cube lowest along each axis, and what they face
    vec4 light[8];  // lx, and 1; nothing where there is no cell
    vec4 plane[8];  // of their surfaces: the normal, and its product with points on it, from the corner of the lowest cube, in cubes
    uint seen;      // 4 bits of each: the columns that it sees
    uint cut;       // a bit of those that have a cut
    uvec2 cuts;     // those, a byte of each
};

// Of a vector: along a side, and across it the two axes after that.
vec3 turned_to(uint axis, vec3 v) { return axis == 0u ? v.xyz : axis == 1u ? v.yzx : v.zxy; }
vec3 turned_back(uint axis, vec3 v) { return axis == 0u ? v.xyz : axis == 1u ? v.zxy : v.yzx; }

Corners corners_of(ivec4 of) {
    Corners corners;
    corners.of = of, corners.seen = 0u, corners.cut = 0u, corners.cuts = uvec2(0u);
    const uint axis = axis_of(uint(of.w));
    [[unroll]] for (uint k = 0u; k < 8u; ++k) {
        const uvec3 step = uvec3(k & 1u, k >> 1u & 1u, k >> 2u);
        const vec3 offset = turned_back(axis, vec3(step));
        const uint number = number_of(vec3(of.xyz) + offset, push.cubes, uint(of.w), kCellFacings);
        const uvec4 cell = find(number);
        const bool there = cell.x == number && number != kNoCell;
        const vec3 normal = decode_normal(unpackSnorm4x8(cell.w).zw);
        corners.light[k] = there ? vec4(light_of(cell), 1.0) : vec4(0.0);
        corners.plane[k] = vec4(normal, dot(normal, offset + 0.5) + unpackHalf2x16(cell.w).x);
        const uint cut = there ? cell.z >> 24u : 0u;
        corners.cut |= cut != 0u ? 1u << k : 0u;
        corners.cuts[k >> 2u] |= cut << 8u * (k & 3u);
        const uint walls = there ? cell.z >> 16u & 0xffu : 0u;
        [[unroll]] for (uint column = 0u; column < 4u; ++column) {
            const ivec2 other = ivec2(column & 1u, column >> 1u) - ivec2(step.yz);
            const int bit = 3 * (other.y + 1) + other.x + 1;
            const bool seen = other == ivec2(0) || (walls >> uint(bit > 4 ? bit - 1 : bit) & 1u) == 0u;
            corners.seen |= (seen ? 1u : 0u) << 4u * k + column;
        }
    }
    return corners;
}

uint cut_of(Corners corners, uint k) { return (k < 4u ? corners.cuts.x : corners.cuts.y) >> 8u * (k & 3u) & 0xffu; }
// Unit length; of the two axes across the side, or the diagonals between them.
vec2 cut_way(uint cut) {
    const float x = cut < 0x40u ? 1.0 : cut < 0x80u ? 0.0 : kDiagonal, y = cut < 0x40u ? 0.0 : cut < 0x80u ? 1.0 : kDiagonal;
    return vec2(x, cut < 0xc0u ? y : -y);
}
// How far beyond the plane of a cut a point is, from the middle of its cube, cubes; negative on the side of the cell.
float past_cut(uint cut, vec2 from_middle) {
    const float past = dot(from_middle, cut_way(cut)) + 0.5 - (float(cut & kCutSteps - 1u) + 0.5) / float(kCutSteps);
    return (cut & kCutSteps) != 0u ? past : -past;
}

// Of light and its weight, the sum over the corners.
vec4 on_surfaces(Corners corners, vec3 at) {
    const vec3 local = at - vec3(corners.of.xyz);
    const uint axis = axis_of(uint(corners.of.w));
    const vec3 share = turned_to(axis, clamp(local - 0.5, 0.0, 1.0));
    const vec2 across = turned_to(axis, local).yz;
    uint off = 0u, left = corners.cut;  // a bit of each corner: a cut parts it from the point; the cuts to look at
    do {
        const uint k = left != 0u ? uint(findLSB(left)) : 0u, cut = cut_of(corners, k);
        off |= cut != 0u && past_cut(cut, across - vec2(k >> 1u & 1u, k >> 2u) - 0.5) > 0.0 ? 1u << k : 0u;
        left &= left - 1u;
    } while (left != 0u);
    // The cell of the point's cube says which columns are seen; where it is cut off, that beside it on the same side of the cut.
    const uvec3 nearest = uvec3(greaterThanEqual(share, vec3(0.5)));
    const uint own = nearest.x | nearest.y << 1u | nearest.z << 2u, own_cut = cut_of(corners, own);
    const vec2 away = cut_way(own_cut) * ((own_cut & kCutSteps) != 0u ? 1.0 : -1.0);
    const uvec2 beyond = uvec2(greaterThan((across - vec2(nearest.yz) - 0.5) * away, vec2(0.0)));
    const uint seen = corners.seen >> 4u * (own ^ ((off >> own & 1u) != 0u ? beyond.x << 1u | beyond.y << 2u : 0u));
    vec4 sum = vec4(0.0);
    [[unroll]] for (uint column = 0u; column < 4u; ++column) {
        const float linear = ((column & 1u) != 0u ? share.y : 1.0 - share.y) * ((column & 2u) != 0u ? share.z : 1.0 - share.z);
        vec4 both = vec4(0.0);
        [[unroll]] for (uint layer = 0u; layer < 2u; ++layer) {
            const uint k = 2u * column + layer;
            const float same = max(1.0 - abs(dot(corners.plane[k].xyz, local) - corners.plane[k].w) / kSameSurface, kElsewhere);
            const float part = (off >> k & 1u) != 0u ? 0.0 : linear * (layer != 0u ? share.x : 1.0 - share.x) * same;
            both += (part + kLeastWeight) * corners.light[k];
        }
        sum += (seen >> column & 1u) != 0u ? both : vec4(0.0);
    }
    return sum;
}

// The same over eight cubes of air, of each the sides that the normal goes to by the squares of its components.
vec4 in_air(vec3 at, vec3 normal) {
    const vec3 air = at / float(push.air_cubes) - 0.5, corner = floor(air), share = air - corner;
    const vec3 parts = normal * normal / dot(normal, normal), cubes = vec3((uvec3(push.cubes) + push.air_cubes - 1u) / push.air_cubes);
    const uint begins = uint(push.cubes.x) * uint(push.cubes.y) * uint(push.cubes.z) * kCellFacings;
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < 24u; ++k) {
        const uint axis = k >> 3u;
        const vec3 offset = vec3(k & 1u, k >> 1u & 1u, k >> 2u & 1u), linear = mix(1.0 - share, share, offset);
        const float component = axis == 0u ? normal.x : axis == 1u ? normal.y : normal.z;
        const uint number = number_of(corner + offset, cubes, 2u * axis + (component < 0.0 ? 1u : 0u), kCellSides);
        const uvec4 cell = find(number == kNoCell ? kNoCell : begins + number);
        const float part = axis == 0u ? parts.x : axis == 1u ? parts.y : parts.z;
        const float weight = part * (linear.x * linear.y * linear.z + kLeastWeight);
        sum += cell.x == kNoCell ? vec4(0.0) : weight * vec4(light_of(cell), 1.0);
    }
    return sum;
}

// A pixel's surface, and where it is in the grid.
struct Point {
    vec3 position, n;  // in the view frame, m
    vec3 at, normal;   // in cubes; this is no unit vector
    ivec4 part;        // of a cube, and what it faces
    float plain;       // of roads, see road_in_diffuse
    bool drawn;
};

Point point_of(uvec2 pixel) {
    const vec4 surface = imageLoad(surface_image, ivec2(pixel));
    Point point;
    point.drawn = all(lessThan(pixel, push.size)) && surface.z > 0.0;
    point.position = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0) * (point.drawn ? surface.z : 1.0);
    point.n = decode_normal(point.drawn ? surface.xy : vec2(0.0));
    point.at = push.eye + push.x_axis * point.position.x + push.y_axis * point.position.y + push.z_axis * point.position.z;
    point.normal = push.x_axis * point.n.x + push.y_axis * point.n.y + push.z_axis * point.n.z;
    point.plain = -surface.w;
    point.part = ivec4(floor(point.at - 0.5), facing_of(point.normal));
    return point;
}

// Light and its weight.
void add(uvec2 pixel, Point point, vec4 found) {
    const vec3 normal = point.normal;
    const vec3 open = mix(push.sky_below, push.sky_above, 0.5 + 0.5 * normal.y * inversesqrt(dot(normal, normal)));
    vec3 illuminance = found.w > 0.0 ? found.rgb / found.w : open;
    if (kMoving != 0u) {
        const vec4 moving = imageLoad(moving_light_image, ivec2(pixel));
        illuminance = illuminance * moving.a + moving.rgb;
    }
    const vec4 reflectance = imageLoad(reflectance_image, ivec2(pixel)), was = imageLoad(scene_image, ivec2(pixel));
    const bool road = reflectance.a <= kRoadKind;
    const float seen = road ? road_in_diffuse(point.plain, -dot(point.n, normalize(point.position))) : 1.0;
    imageStore(scene_image, ivec2(pixel), vec4(was.rgb + illuminance * reflectance.rgb * (push.lambert * seen), 1.0));
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kRows);
    uint r = 0u, alone = 0u;  // rows beside no cell of a surface, a bit each
    // A run of rows in one part of a cube shares its corners. A CPU device goes through what a branch leaves out, but leaves loops that
    // ask at their end.
    do {
        const ivec4 part = point_of(first + uvec2(0u, r)).part;
        const Corners corners = corners_of(part);
        bool more;
        do {
            const uvec2 pixel = first + uvec2(0u, r);
            const Point point = point_of(pixel);
            if (point.drawn) {
                const vec4 found = on_surfaces(corners, point.at);
                if (found.w >= 2.0 * kElsewhere) {
                    add(pixel, point, found);
                } else {
                    alone |= 1u << r;
                }
            }
            ++r;
            const Point next = point_of(first + uvec2(0u, r));
            more = r < kRows && (!next.drawn || next.part == part);
        } while (more);
    } while (r < kRows);
    do {
        if (alone != 0u) {
            const uvec2 pixel = first + uvec2(0u, uint(findLSB(alone)));
            const Point point = point_of(pixel);
            const vec4 air = in_air(point.at, point.normal);
            add(pixel, point, air.w > 0.0 ? air : on_surfaces(corners_of(point.part), point.at));
        }
        alone &= alone - 1u;
    } while (alone != 0u);
}
