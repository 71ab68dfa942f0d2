// Retroreflection: shared/retro.h. Wants TEXELS retro_classes.

#include "shared/retro.h"

// Which class a metallic of the G-buffer stands for; kRetroClasses: none.
uint retro_class(float metallic) {
    return metallic >= kRetroCode ? min(uint(metallic - kRetroCode + 0.5), kRetroClasses - 1u) : kRetroClasses;
}

// RetroBase::chord2.
float retro_chord2(uint class_) { return texel_at(retro_classes, int(class_ * kRetroTexels + kRetroRamps)).w; }

// Luminance per illuminance facing the lamp, sr^-1, where the base colour is 1. The observation angle is small where it
// matters: the chord between the two directions is exact where their dot product is not.
float retroreflection(uint class_, vec3 toward_lamp, vec3 toward_eye, float normal_lamp, float normal_eye) {
    const int first = int(class_ * kRetroTexels);
    const vec3 chord = toward_lamp - toward_eye;
    // 2 asin(h) as a series, within 1e-4 up to 60 degrees, beyond which nothing is left of real sheets; asin() may be off by more.
    const float h2 = 0.25 * dot(chord, chord);
    const float angle = 2.0 * sqrt(h2) * (1.0 + h2 * (1.0 / 6.0 + h2 * (3.0 / 40.0 + h2 * (5.0 / 112.0))));
    const vec4 base = texel_at(retro_classes, first + int(kRetroRamps));
    float log2_coefficient = base.x, factor = base.y;
    vec4 ramp = texel_at(retro_classes, first);
    for (uint i = 0u; i < kRetroRamps; ++i) {
        const bool last = i + 1u == kRetroRamps;
        const vec4 next = last ? vec4(4.0, 0.0, 0.0, 0.0) : texel_at(retro_classes, first + int(i) + 1);
        log2_coefficient += ramp.y * clamp(angle - ramp.x, 0.0, next.x - ramp.x);
        factor += ramp.w * clamp(ramp.z - normal_lamp, 0.0, ramp.z - next.z);
        ramp = next;
    }
    const float spread = base.z > 0.0 ? 1.0 / max(normal_eye, kRetroLeastCosine) : 1.0;
    return exp2(max(log2_coefficient, -100.0)) * max(factor, 0.0) * spread;
}
