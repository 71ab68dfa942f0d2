// Holes of masked surfaces. Wants `masks`, kAnisotropy, and what facets.glsl wants.

// A texture coordinate, in the texels of a level, from the middle of its first.
float wrapped(float at, uint wrap, float size) {
    if (wrap == kMaskRepeats) return fract(at) * size - 0.5;
    const float place = wrap == kMaskMirrors ? abs(at - 2.0 * round(0.5 * at)) : at;
    return clamp(place * size - 0.5, 0.0, size - 1.0);
}

// The points of the pixel at which a facet has holes, a bit each. Its texture is that of the level whose texels are as large as a
// pixel where the facet is seen.
uint holes_of(SeenFacet facet, vec2 there) {
    const int header = int(max(facet.mask, 1.0) - 1.0) * int(kWordsPerMask);  // of what has no mask the first is asked, for nothing
    const vec3 a = facet.corners[0], b = facet.corners[1], c = facet.corners[2];
    const vec2 uv_a = texel_at(vertices, int(facet.vertices.x * kTexelsPerVertex + kUvTexel)).xy;
    const vec2 uv_b = texel_at(vertices, int(facet.vertices.y * kTexelsPerVertex + kUvTexel)).xy;
    const vec2 uv_c = texel_at(vertices, int(facet.vertices.z * kTexelsPerVertex + kUvTexel)).xy;
    // Linear over the pixel: u and v over depth.
    const mat3 weights = mat3(cross(b, c), cross(c, a), cross(a, b)) / dot(a, cross(b, c));
    const vec3 u = weights * vec3(uv_a.x, uv_b.x, uv_c.x), v = weights * vec3(uv_a.y, uv_b.y, uv_c.y);
    const uint sides = texel_at(masks, header).r, kind = texel_at(masks, header + 1).r;
    const ivec2 size = ivec2(sides & 0xffffu, sides >> 16u);
    const float cutoff = uintBitsToFloat(texel_at(masks, header + 2).r);
    // How far a step of a pixel goes, in texels of the first level.
    const vec3 q = vec3(there, 1.0);
    const vec2 middle_uv = vec2(dot(u, q), dot(v, q)) / dot(facet.inverse_depth, q);
    const vec2 step_x = (vec2(u.x, v.x) - middle_uv * facet.inverse_depth.x) / dot(facet.inverse_depth, q) * vec2(size);
    const vec2 step_y = (vec2(u.y, v.y) - middle_uv * facet.inverse_depth.y) / dot(facet.inverse_depth, q) * vec2(size);
    const float longer = max(length(step_x), length(step_y)), shorter = min(length(step_x), length(step_y));
    const float level_at = log2((kind & kMaskNearest) != 0u ? longer : max(shorter, longer / float(kAnisotropy)));
    const int level = int(clamp(floor(level_at + 0.5), 0.0, max(float(kind >> 8u) - 1.0, 0.0)));
    const int first = int(texel_at(masks, header + 3 + level).r);
    const ivec2 texels = max(size >> level, 1);
    uint left = facet.mask > 0.0 ? kAllPoints : 0u, holes = 0u;
    do {
        const uint i = uint(max(findLSB(left), 0));
        left &= left - 1u;
        const vec3 p = vec3(place_of(i), 1.0);
        const vec2 uv = vec2(dot(u, p), dot(v, p)) / dot(facet.inverse_depth, p);
        const vec2 at = vec2(wrapped(uv.x, kind & 3u, float(texels.x)), wrapped(uv.y, kind >> 2u & 3u, float(texels.y)));
        const vec2 low = floor(at);
        vec2 f = at - low;
        f = (kind & kMaskNearest) != 0u && level_at <= 0.0 ? step(0.5, f) : f;
        const ivec2 texel = clamp(ivec2(low) + texels * ivec2(lessThan(low, vec2(0.0))), ivec2(0), texels - 1);
        const vec4 four = unpackUnorm4x8(texel_at(masks, first + texel.y * texels.x + texel.x).r);
        const float opacity = mix(mix(four.x, four.y, f.x), mix(four.z, four.w, f.x), f.y);
        holes |= facet.mask > 0.0 && opacity < cutoff ? 1u << i : 0u;
    } while (left != 0u);
    return holes;
}
