// From the frame of a map to a quadrant of a hemisphere (shared/shadow_map.h).

struct InQuadrant {
    vec4 position;      // clip space of the whole hemisphere; w is the norm
    float outside[7];   // less than 0: not in the quadrant, or beside the square
};

// `q`: mirrored as the quadrant is.
InQuadrant to_quadrant(vec3 q, MapQuadrant quadrant) {
    const float x = quadrant.y_sign == 0.0 ? 0.0 : quadrant.zoom < 0.0 ? -q.x : q.x, y = quadrant.y_sign * q.y;
    const float norm = x + y + q.z;
    const vec2 square = abs(quadrant.zoom) * vec2(q.x + q.y, q.x - q.y);
    InQuadrant at;
    at.position = vec4(square, kMapNear, norm);
    at.outside[0] = x + quadrant.overlap * norm;
    at.outside[1] = y + quadrant.overlap * norm;
    at.outside[2] = q.z + quadrant.overlap * norm;
    at.outside[3] = norm + square.x;
    at.outside[4] = norm + square.y;
    at.outside[5] = norm - square.x;
    at.outside[6] = norm - square.y;
    return at;
}

// The same where it is rasterized: all hemispheres lie in the corner of one square.
vec4 in_raster(InQuadrant at, MapQuadrant quadrant) {
    const float part = float(quadrant.side) / float(kRasterSide);
    return vec4((at.position.xy + at.position.w) * part - at.position.w, at.position.zw);
}
