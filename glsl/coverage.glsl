// Areas that convex silhouettes cover of pixels. Wants `silhouettes`.

// The area between an edge and the line x = 0 within the unit square: the integral of clamp(x, 0, 1) over the edge's y,
// signed by its direction. Over a closed silhouette that adds up to the area inside, and every term is without cancellation.
float area_left_of(vec2 a, vec2 b) {
    const float low = clamp(a.y, 0.0, 1.0), high = clamp(b.y, 0.0, 1.0), run = b.y - a.y;
    const float slope = run == 0.0 ? 0.0 : (b.x - a.x) / run;
    const float x0 = a.x + (low - a.y) * slope, x1 = a.x + (high - a.y) * slope;
    const float left = min(x0, x1), right = max(x0, x1), width = right - left;
    const float l = clamp(left, 0.0, 1.0), r = clamp(right, 0.0, 1.0);
    const float inside = 0.5 * (r - l) * (r + l) + max(right - max(left, 1.0), 0.0);
    const float mean = width > 1e-6 ? inside / width : clamp(left, 0.0, 1.0);
    return mean * (high - low);
}

// Covered part of the pixel whose corner lies at `corner` from the silhouette's origin.
float coverage(vec2 corner, int first, int vertices) {
    float area = 0.0;
    vec2 a = texel_at(silhouettes, first + max(vertices, 1) - 1).xy - corner, low = vec2(1e30), high = vec2(-1e30);
    for (int i = 0; i < vertices; ++i) {
        const vec2 b = texel_at(silhouettes, first + i).xy - corner;
        area += area_left_of(a, b);
        low = min(low, b), high = max(high, b);
        a = b;
    }
    // Beside a silhouette the sum is nothing but rounding, which shows when it is multiplied by the luminance of a headlamp.
    const bool beside = any(lessThanEqual(high, vec2(0.0))) || any(greaterThanEqual(low, vec2(1.0)));
    return beside ? 0.0 : clamp(area, 0.0, 1.0);
}
