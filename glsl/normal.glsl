// Octahedral map of a unit vector (Meyer et al. 2010): two numbers in [-1, 1], and back.

vec2 encode_normal(vec3 n) {
    const vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    const vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return n.z < 0.0 ? folded : p;
}

vec3 decode_normal(vec2 p) {
    const float z = 1.0 - abs(p.x) - abs(p.y);
    const vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return normalize(vec3(z < 0.0 ? folded : p, z));
}
