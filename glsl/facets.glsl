// The facets that the middles of pixels see, from the middle of a pixel in px. Wants `instances`, `vertices`, `facets`,
// `push` with ray_scale, and kPoints, how many points a pixel has.

const float kTriangleWidth = 0.5;  // of its least height: in the mean over the triangle

// Point i of a pixel.
vec2 place_of(uint i) {
    const float half_row = kPoints > 8u ? 1.0 / 32.0 : kPoints > 4u ? 1.0 / 16.0 : 1.0 / 8.0;
    return vec2((float(i) + 0.5) / float(kPoints), float(bitfieldReverse(i) >> 28u) / 16.0 + half_row) - 0.5;
}

vec4 row_x, row_y, row_z;  // of the instance
vec2 middle;               // the pixel sees along (middle, -1)

// A corner from the middle of the pixel, px, times its depth; and its depth, m.
vec3 corner(uint vertex) {
    const int at = int(vertex * kTexelsPerVertex);
    const vec4 p = vec4(texel_at(vertices, at).xy, texel_at(vertices, at + 1).x, 1.0);
    const float depth = -dot(row_z, p);
    return vec3((vec2(dot(row_x, p), dot(row_y, p)) - middle * depth) / push.ray_scale, depth);
}

// Linear over the pixel: the distance from the line through two places, px, to the right seen from the first.
vec3 line(vec3 a, vec3 b) {
    const vec3 n = cross(a, b);
    return n / max(length(n.xy), 1e-30);
}

// Of a triangle over one of its edges, px. Where its tip is behind the eye it goes on.
float height(vec3 edge, vec3 tip) { return tip.z > 0.0 ? dot(edge, tip) / tip.z : 1e30; }

struct SeenFacet {
    vec3 sides[4];       // distances of a place (px, 1) from the lines along its edges, px, positive inside
    vec3 inverse_depth;  // of a place (px, 1) of its plane, 1/m
    bool narrow;         // narrower than a pixel
    float mask;          // Instance::mask
    float placement;     // number of its mesh
    vec3 corners[3];     // see corner()
    uvec3 vertices;
};

// The facet of the triangle (of GBuffer::triangle) that the middle `there` px away sees.
SeenFacet facet_of(uvec2 triangle, vec2 there) {
    const int row = int((triangle.r - 1u) * kTexelsPerInstance);
    row_x = texel_at(instances, row), row_y = texel_at(instances, row + 1), row_z = texel_at(instances, row + 2);
    const vec4 kind = texel_at(instances, row + 3);
    const uvec4 others = texel_at(facets, int(triangle.g));
    const vec3 a = corner(triangle.g), b = corner(others.x), c = corner(others.y), d = corner(others.z);
    const float front = dot(c, cross(a, b)) + dot(d, cross(a, c)) < 0.0 ? -1.0 : 1.0;
    const vec3 ab = front * line(a, b), bc = front * line(b, c), da = front * line(d, a);
    const bool triangular = others.y == others.z;
    const vec3 cd = triangular ? vec3(0.0) : front * line(c, d);
    const vec3 p = vec3(there, 1.0);
    const float width = triangular ? kTriangleWidth * min(min(height(ab, c), height(bc, a)), height(da, b)) : min(dot(ab + cd, p), dot(bc + da, p));
    const vec3 inverse_depth = (cross(a, b) + cross(b, c) + cross(c, a)) / dot(c, cross(a, b));
    return SeenFacet(vec3[](ab, bc, cd, da), inverse_depth, width < 1.0, kind.y, kind.z, vec3[](a, b, c), uvec3(triangle.g, others.xy));
}

// Of a place (px, 1): how far it is from the nearest line along an edge, px; negative outside.
float inside(SeenFacet facet, vec3 place) {
    return min(min(dot(facet.sides[0], place), dot(facet.sides[1], place)), min(dot(facet.sides[2], place), dot(facet.sides[3], place)));
}
