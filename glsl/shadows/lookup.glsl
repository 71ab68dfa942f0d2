// Whether a lamp sees a point of a surface (shared/shadow_map.h). Needs TEXELS maps, two texels per lamp, and
// HALVES distances.

#include "shared/shadow_map.h"

const float kLeastCosine = 0.02;  // between a surface's normal and the way to the eye

struct FetchedMap {
    mat3 rotation;     // from the view frame to that of the map
    int first, side;
    float zoom;
    bool both;     // hemispheres
    float fold;    // weight of |x| and |y| in the norm: 0 of a flat map, otherwise 1
    float radius;  // m
    float bias;    // times the distance, see kMapBias
};

// Of a unit quaternion.
mat3 rotation_of(vec4 q) {
    const vec3 x = 2.0 * q.x * q.xyz, y = 2.0 * q.y * q.xyz, z = 2.0 * q.z * q.xyz, w = 2.0 * q.w * q.xyz;
    return mat3(1.0 - y.y - z.z, x.y + w.z, x.z - w.y, x.y - w.z, 1.0 - x.x - z.z, y.z + w.x, x.z + w.y, y.z - w.x, 1.0 - x.x - y.y);
}

FetchedMap fetch_map(uint lamp) {
    const vec4 q = texel_at(maps, int(lamp * kShadowMapTexels)), b = texel_at(maps, int(lamp * kShadowMapTexels) + 1);
    return FetchedMap(rotation_of(q), int(b.x) * int(kMapUnit), int(abs(b.y)), abs(b.z), b.z < 0.0, b.y < 0.0 ? 0.0 : 1.0, b.w, 1.0 / max(abs(b.y * b.z), 1.0) + kMapRounding);
}

// A surface as a map sees it.
struct MapPoint {
    vec2 texel;     // of the hemisphere's square, (0, 0) in its corner
    float norm;     // distance, m, in the norm of the maps
    int first;      // texel of the hemisphere
    bool inside;    // the map reaches it
    vec3 plane;     // the inverse distance of the surface's plane is plane.xy . texel + plane.z, within the point's quadrant
};

// `from`: the lamp, to a point of a surface with this normal; in the view frame.
MapPoint map_point(FetchedMap map, vec3 from, vec3 normal) {
    vec3 q = map.rotation * from, n = map.rotation * normal;
    const bool behind = q.z < 0.0;
    q.z = abs(q.z);
    n.z = behind ? -n.z : n.z;
    const float norm = max(map.fold * (abs(q.x) + abs(q.y)) + q.z, 1e-6);
    const vec2 square = map.zoom / norm * vec2(q.x + q.y, q.x - q.y);
    const int hemisphere = behind && map.both ? map.side * map.side : 0;
    const bool inside = map.side > 0 && (map.both || !behind) && max(abs(square.x), abs(square.y)) <= 1.0 && norm < 0.8 * kMapFar;
    // n . o / (n . q), o = (x, y, 1 - fold (|x| + |y|)) with x, y = (u + v, u - v) / 2 zoom, u = 2 texel / side - 1.
    const float folded = map.fold * n.z;
    const vec2 along = vec2(n.x - (q.x < 0.0 ? -folded : folded), n.y - (q.y < 0.0 ? -folded : folded));
    const float away = dot(n, q);
    const float inverse = abs(away) > 1e-4 * norm ? 1.0 / away : 0.0;  // of a surface seen from its edge nothing is known
    const vec2 slope = inverse * 0.5 / map.zoom * vec2(along.x + along.y, along.x - along.y);
    const vec2 texel = (0.5 * square + 0.5) * float(map.side);
    const vec2 per_texel = slope * (2.0 / float(map.side));
    return MapPoint(texel, norm, map.first + hemisphere, inside, vec3(per_texel, 1.0 / norm - dot(per_texel, texel)));
}

// How far light of the lamp gets along the middle of a texel, in lengths of the way to the plane of the surface; the plane is
// no farther from the point than surfaces bend within a few texels.
float way_along(FetchedMap map, MapPoint p, ivec2 texel, out bool sees) {
    const ivec2 at = clamp(texel, ivec2(0), ivec2(max(map.side, 1) - 1));
    const float seen = half_at(distances, p.first + at.y * map.side + at.x);
    const float inverse = clamp(dot(p.plane.xy, vec2(at) + 0.5) + p.plane.z, 0.5 / p.norm, 2.0 / p.norm);
    sees = (seen + kMapBias + map.bias * p.norm) * inverse >= 1.0;
    return seen * inverse;
}

bool sees(FetchedMap map, MapPoint p, ivec2 texel) {
    bool result;
    way_along(map, p, texel, result);
    return result;
}

// How texels change with two steps from a point, m; all in the frame of the map, the point in its own hemisphere turned to z > 0.
mat2 texels_along(FetchedMap map, vec3 q, vec3 a, vec3 b) {
    const vec3 signs = vec3(q.x < 0.0 ? -map.fold : map.fold, q.y < 0.0 ? -map.fold : map.fold, 1.0);
    const float inverse = 1.0 / max(dot(signs, q), 1e-6);
    const vec2 square = inverse * vec2(q.x + q.y, q.x - q.y);
    const float texels = 0.5 * float(map.side) * map.zoom * inverse;
    return mat2(texels * (vec2(a.x + a.y, a.x - a.y) - square * dot(signs, a)), texels * (vec2(b.x + b.y, b.x - b.y) - square * dot(signs, b)));
}

// How the texels of the map change with a step of a pixel to the right and down, on the plane of a surface at a position in the
// view frame. `pixel`: of a pixel at a depth of 1 m, m.
mat2 texels_per_pixel(FetchedMap map, vec3 from, vec3 position, vec3 normal, vec2 pixel) {
    // Where the plane meets the way to the eye at a grazing angle it goes on for at most 1 / kLeastCosine pixels.
    const float away = dot(normal, position), least = max(kLeastCosine * -position.z, 1e-6);
    const vec2 tilt = normal.xy / (abs(away) > least ? away : away < 0.0 ? -least : least);
    const vec2 size = -position.z * pixel;
    const vec3 right = size.x * (vec3(1.0, 0.0, 0.0) - tilt.x * position), down = size.y * (vec3(0.0, 1.0, 0.0) - tilt.y * position);
    vec3 q = map.rotation * from, x = map.rotation * right, y = map.rotation * down;
    const float front = q.z < 0.0 ? -1.0 : 1.0;
    q.z *= front, x.z *= front, y.z *= front;
    return texels_along(map, q, x, y);
}

// The share of a pixel on the lit side of an edge. `distance`: of its middle from the edge, to the lit side, texels; `change`: of
// that with a step of a pixel. Edges whose width is not finite are sharp, and places that are not see nothing.
float edge_share(float distance, float change) {
    const float width = change > 1e-3 ? min(change, 1.0) : 1e-3;
    return distance >= -1e3 ? clamp(0.5 + distance / width, 0.0, 1.0) : 0.0;
}

// Whether the four texels nearest to a point see the lamp, 0 or 1.
struct FourTexels {
    vec2 low, high;  // rows
};

FourTexels four_texels(FetchedMap map, MapPoint p) {
    const ivec2 corner = ivec2(floor(p.texel - 0.5));
    return FourTexels(vec2(sees(map, p, corner) ? 1.0 : 0.0, sees(map, p, corner + ivec2(1, 0)) ? 1.0 : 0.0),
                      vec2(sees(map, p, corner + ivec2(0, 1)) ? 1.0 : 0.0, sees(map, p, corner + ivec2(1, 1)) ? 1.0 : 0.0));
}

// An edge is where half of their weight sees the lamp, and the pixel gets what lies on the lit side of it.
float share_of(FourTexels four, MapPoint p, mat2 per_pixel) {
    const vec2 share = fract(p.texel - 0.5);
    const vec2 column = mix(four.low, four.high, share.y), row = mix(vec2(four.low.x, four.high.x), vec2(four.low.y, four.high.y), share.x);
    return edge_share(mix(column.x, column.y, share.x) - 0.5, length(vec2(column.y - column.x, row.y - row.x) * per_pixel));
}

// Share of the lamp that a pixel sees, 0 to 1, in fifteenths. `per_pixel`: as texels_per_pixel().
float visibility(FetchedMap map, vec3 from, vec3 normal, mat2 per_pixel) {
    const MapPoint p = map_point(map, from, normal);
    return p.inside ? floor(15.0 * share_of(four_texels(map, p), p, per_pixel) + 0.5) / 15.0 : 1.0;
}

// The same by one texel. `way`: 1, or less where something stops the light: how much of the way it gets.
bool glances(FetchedMap map, vec3 from, vec3 normal, out float way) {
    const MapPoint p = map_point(map, from, normal);
    bool seen;
    way = way_along(map, p, ivec2(floor(p.texel)), seen);
    seen = seen || !p.inside;
    way = seen ? 1.0 : min(way, 1.0);
    return seen;
}

// A direction at right angles to another.
vec3 across(vec3 way) { return normalize(abs(way.x) < abs(way.z) ? vec3(0.0, way.z, -way.y) : vec3(way.y, -way.x, 0.0)); }

// How texels of the map change with a step of 1 m across the way to a point, in two directions.
mat2 texels_across(FetchedMap map, vec3 from) {
    vec3 q = map.rotation * from;
    q.z = abs(q.z);
    const vec3 a = across(q), b = cross(q, a) * inversesqrt(max(dot(q, q), 1e-12));
    return texels_along(map, q, a, b);
}

// A disc of radius 1 as kDisc points, evenly: one of them.
const uint kDisc = 32u;
vec2 disc_point(uint k) {
    const float turn = 2.399963 * float(k);  // the golden angle
    return sqrt((float(k) + 0.5) / float(kDisc)) * vec2(cos(turn), sin(turn));
}
