// Display codes, unchanged where the pixels of the window are those of the picture. Other sizes get means of codes, as a
// screen's own scaler does. Before it: codes() of a pixel, `push` and `shown`.

void main() {
    const ivec2 last_pixel = ivec2(push.size) - 1;
    const vec2 place = (gl_FragCoord.xy - push.origin) * push.step;
    if (push.filtered == 0u) {
        shown = vec4(codes(clamp(ivec2(floor(place)), ivec2(0), last_pixel)), 1.0);
        return;
    }
    const vec2 reach = max(push.step, vec2(1.0));
    const ivec2 first = ivec2(ceil(place - 0.5 - reach)), last = ivec2(floor(place - 0.5 + reach));
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            const vec2 weights = max(1.0 - abs(vec2(x, y) + 0.5 - place) / reach, vec2(0.0));
            sum += weights.x * weights.y * codes(clamp(ivec2(x, y), ivec2(0), last_pixel));
            total += weights.x * weights.y;
        }
    shown = vec4(sum / total, 1.0);
}
