// Reinhard and Devlin 2005: each channel is the response of a photoreceptor, V = I / (I + (f A)^m), that adapts to a mix
// of its pixel and the frame. As in pfstools 2.2.0, responses are sRGB codes, from that to a dark grey (1 % of the frame
// are darker) to that to the brightest one.
//
// Settings: exp(-f'), m (0: from the key of the frame), light adaptation a, chromatic adaptation c. Numbers of a pixel:
// block[0] the same with the m in use; block[1] mean colour of the frame and its luminance; block[2] the response to the
// dark grey, and 1 over the span of responses.

vec3 devlin_response(vec4 set, vec4 average, vec3 rgb, float luminance) {
    const vec3 local = mix(vec3(luminance), rgb, set.w), global = mix(vec3(average.w), average.rgb, set.w);
    const vec3 adaptation = max(mix(global, local, set.z), vec3(1e-20));
    return rgb / (rgb + pow(set.x * adaptation, vec3(set.y)));
}

vec3 devlin_light(vec4 set, vec4 average, vec2 span, vec3 rgb, float luminance) {
    const vec3 code = clamp((devlin_response(set, average, rgb, luminance) - span.x) * span.y, 0.0, 1.0);
    return mix(pow((code + 0.055) / 1.055, vec3(2.4)), code / 12.92, lessThanEqual(code, vec3(0.04045)));
}

#define DEVLIN_RGB

#ifdef OPERATOR_FRAMES

float devlin_grey(vec4 average, float luminance) {
    return dot(devlin_response(made.block[0], average, vec3(luminance), luminance), vec3(kRed, kGreen, kBlue));
}

// Of the finite pixels of the frame.
vec3 mean_colour(float mean) {
    vec3 sum = vec3(0.0);
    float pixels = 0.0;
    for (uint i = gl_LocalInvocationIndex; i < parameters.colour_tiles.x * parameters.colour_tiles.y; i += kMaxBins) {
        const vec4 tile = imageLoad(colours, ivec2(i % parameters.colour_tiles.x, i / parameters.colour_tiles.x));
        sum += tile.a * tile.rgb;
        pixels += tile.a;
    }
    const vec3 all_sums = vec3(sum_of(sum.r), sum_of(sum.g), sum_of(sum.b));
    const float all_pixels = sum_of(pixels);
    return all_pixels > 0.0 ? all_sums / all_pixels : vec3(mean);
}

void devlin_frame(Frame frame) {
    find_percentiles(frame);
    const float ln_high = log(max(frame.maximum, kLuminanceFloor)), ln_low = min(percentile[0], ln_high - 1.0);
    const float key = clamp((ln_high - log(frame.log_average)) / (ln_high - ln_low), 0.0, 1.0);
    made.block[0] = parameters.settings[0];
    if (made.block[0].y == 0.0) made.block[0].y = 0.3 + 0.7 * pow(key, 1.4);
    made.block[1] = vec4(mean_colour(frame.mean), frame.mean);
    const float low = devlin_grey(made.block[1], exp(ln_low)), high = devlin_grey(made.block[1], exp(ln_high));
    made.block[2] = vec4(low, 1.0 / max(high - low, 1e-6), 0.0, 0.0);
    begin_table();
    for (uint i = gl_LocalInvocationIndex; i <= kMaxNodes; i += kMaxBins) {
        const float l = table_luminance(i);
        const vec3 light = devlin_light(made.block[0], made.block[1], made.block[2].xy, vec3(l), l);
        curve.node[i] = node_of(dot(light, vec3(kRed, kGreen, kBlue)));
    }
}

#else

vec3 devlin_rgb(Tone tone, vec3 rgb) {
    rgb = max(rgb, vec3(0.0));
    return devlin_light(tone.block[0], tone.block[1], tone.block[2].xy, rgb, luminance_of(rgb));
}

#endif
