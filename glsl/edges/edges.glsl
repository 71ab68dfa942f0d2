// Surfaces seen by pixels. Wants `triangles`, `surface_image`, `facets` and `push` of EdgesPush.

#include "neighbours.glsl"

struct Seen {
    uint instance;  // 0: nothing
    uint region;
    vec3 normal, position;
    bool relief;
};

Seen seen_at(ivec2 pixel) {
    const vec4 surface = imageLoad(surface_image, pixel);
    const vec3 ray = vec3(push.ray_scale * (vec2(pixel) + 0.5) + push.ray_offset, -1.0);
    const uvec2 triangle = imageLoad(triangles, pixel).rg;
    return Seen(triangle.r, texel_at(facets, int(triangle.g)).w, decode_normal(surface.xy), ray * surface.z, is_relief(surface.xy));
}

// Normals of a relief say nothing of planes: there a region is one surface.
bool is_same(Seen a, Seen b) {
    const vec3 between = b.position - a.position;
    // As far as a bend between the two normals takes one from the other's plane, and rounding of depths.
    const float most = distance(a.normal, b.normal) * length(between) + kSamePlane * -min(a.position.z, b.position.z);
    const bool smooth_ = dot(a.normal, b.normal) >= kSameNormal && abs(dot(a.normal, between)) <= most && abs(dot(b.normal, between)) <= most;
    return a.instance == b.instance && (a.instance == 0u || (a.region == b.region && (smooth_ || (a.relief && b.relief))));
}
