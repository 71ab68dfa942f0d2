// Lamps of any kind: fetched, and evaluated in a direction. Needs TEXELS lamps, TEXELS tables and the constants
// kPowers and kTables.

#include "tables.glsl"
#include "shared/lamp.h"

struct FetchedLamp {
    vec3 position;
    float intensity;
    vec3 axis;
    float lobe_a;
    vec3 colour;
    float lobe_b;
    // Of a table.
    bool measured;
    vec3 start, turn, pole;
    float first, last_azimuth;
    vec4 grid;
};

// `tables_from`: index of the first measured lamp.
FetchedLamp fetch(uint index, bool cone, uint tables_from) {
    const int texel = int(index * kTexelsPerLamp);
    const vec4 a = texel_at(lamps, texel), c = texel_at(lamps, texel + 2);
    vec4 b = vec4(0.0), d = vec4(0.0), e = vec4(0.0), f = vec4(0.0);
    if (cone || kPowers != 0u) b = texel_at(lamps, texel + 1);
    if (!cone && kTables != 0u) d = texel_at(lamps, texel + 3), e = texel_at(lamps, texel + 4), f = texel_at(lamps, texel + 5);
    return FetchedLamp(a.xyz, a.w, b.xyz, b.w, c.rgb, c.w, kPowers == 0u || index >= tables_from,
                d.xyz, turn_of(d.xyz, e.xyz, e.w), e.xyz, d.w, abs(e.w), f);
}

// Intensity in a direction relative to the largest. `cosine` to the axis; `from` the lamp, of any length; `at`, of a table, see table_intensity.
float relative_intensity(FetchedLamp lamp, float cosine, vec3 from, float inverse, bool cone, out vec2 at) {
    at = vec2(0.0);
    if (cone) {
        const float ramp = clamp(lamp.lobe_a * cosine + lamp.lobe_b, 0.0, 1.0);
        return ramp * ramp;
    }
    float relative = 0.0;
    if (kPowers != 0u) relative = cosine > 0.0 ? exp2(lamp.lobe_a * log2(cosine)) : 0.0;
    if (kTables != 0u) {
        const vec3 d = vec3(dot(lamp.start, from), dot(lamp.turn, from), dot(lamp.pole, from));
        const float mapped = table_intensity(d, inverse, lamp.grid, lamp.first, vec2(lamp.last_azimuth, lamp.lobe_b), at);
        relative = lamp.measured ? mapped : relative;
    }
    return relative;
}
float relative_intensity(FetchedLamp lamp, float cosine, vec3 from, float inverse, bool cone) {
    vec2 at;
    return relative_intensity(lamp, cosine, from, inverse, cone, at);
}
