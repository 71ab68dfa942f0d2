// From the frame of a map to a quadrant of a hemisphere in the image (shared/shadow_map.h).

struct InQuadrant {
    vec4 position;      // clip space; w is the norm
    float outside[7];   // less than 0: not in the quadrant, or beside the window
};

// `place`, `window`, `y_sign`, `overlap` as in MapInstance.
InQuadrant to_quadrant(vec3 q, vec4 place, vec4 window, float y_sign, float overlap) {
    const float x = y_sign == 0.0 ? 0.0 : place.w < 0.0 ? -q.x : q.x, y = y_sign * q.y;
    const float norm = x + y + q.z;
    const vec2 square = abs(place.w) * vec2(q.x + q.y, q.x - q.y);
    InQuadrant at;
    at.position = vec4(place.x * square + norm * place.yz, kMapNear, norm);
    at.outside[0] = x + overlap * norm;
    at.outside[1] = y + overlap * norm;
    at.outside[2] = q.z + overlap * norm;
    at.outside[3] = square.x - window.x * norm;
    at.outside[4] = square.y - window.y * norm;
    at.outside[5] = window.z * norm - square.x;
    at.outside[6] = window.w * norm - square.y;
    return at;
}
