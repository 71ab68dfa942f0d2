// Chromatic adaptation: what the responses of the three kinds of cones are multiplied by, after von Kries, as far as the eye
// adapts at its luminance (CIECAM02). Half of it at once, half with a half-life of 20 s (Rinner and Gegenfurtner 2000).
// For adapt.comp.

const float kAtOnce = 0.5, kSlowSeconds = 20.0 / 0.6931471806;

mat3 to_cones() { return transpose(mat3(kLongCones, kMiddleCones, kShortCones)); }

// ln of the cones' responses to the colour that the eye looks at, over those to white of the same luminance: the log average of
// the tiles. Every invocation must call it. Nothing to see: as it was.
vec3 looked_at_chroma(vec3 before) {
    vec3 sum = vec3(0.0);
    float pixels = 0.0;
    for (uint i = gl_LocalInvocationIndex; i < parameters.colour_tiles.x * parameters.colour_tiles.y; i += kMaxBins) {
        const vec4 tile = imageLoad(colours, ivec2(i % parameters.colour_tiles.x, i / parameters.colour_tiles.x));
        sum += tile.a * log(max(to_cones() * max(tile.rgb, vec3(0.0)), vec3(kLuminanceFloor)));
        pixels += tile.a;
    }
    const vec3 all_sums = vec3(sum_of(sum.x), sum_of(sum.y), sum_of(sum.z));
    const float all_pixels = sum_of(pixels);
    if (all_pixels == 0.0) return before;
    const vec3 cones = exp(all_sums / all_pixels);
    const float luminance = max(dot(inverse(to_cones()) * cones, vec3(kRed, kGreen, kBlue)), kLuminanceFloor);
    return log(cones / (luminance * (to_cones() * vec3(1.0))));
}

// Rec. 709 to Rec. 709 as the eye sees it.
mat3 chromatic_adaptation(vec3 chroma, float luminance) {
    const float degree = 1.0 - exp(-(luminance + 42.0) / 92.0) / 3.6;
    const vec3 gain = degree * exp(-chroma) + 1.0 - degree;
    return inverse(to_cones()) * mat3(gain.x, 0.0, 0.0, 0.0, gain.y, 0.0, 0.0, 0.0, gain.z) * to_cones();
}
