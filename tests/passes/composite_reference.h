// From scene luminance to display codes, one pixel after another. SPDX-License-Identifier: MIT
// Displayed light is relative: 0 at the display's darkest luminance, 1 at its brightest.
#pragma once

#include "passes/pyramid_reference.h"
#include "shared/composite.h"

namespace vesper::reference {

/// Luminance of a code V in [0, 1], cd/m^2 (Mantiuk, Daly and Kerofsky 2008): (peak - black) V^gamma + black + k E /
/// pi.
inline double display_luminance(double code, double peak, double black, double gamma, double ambient,
                                double reflection) {
    return (peak - black) * std::pow(code, gamma) + black + reflection * ambient / 3.14159265358979323846;
}

/// Displayed luminance of a scene luminance, relative, for the operators that map luminance.
inline double tone_mapped(double y, uint32_t tone, const shared::ToneCurve& c, double display_low,
                          double display_high) {
    double d = 0;
    if (tone == shared::kToneCurve) {
        const double t =
            std::clamp((std::log(std::max(y, kFloor)) - c.ln_low) * double(c.bins_per_ln), 0.0, double(c.bins));
        const uint32_t i = std::min(uint32_t(t), uint32_t(c.bins) - 1);
        const double ln = c.node[i].x + (double(c.node[i + 1].x) - c.node[i].x) * (t - i);
        d = (std::exp(ln) - display_low) / (display_high - display_low);
    } else if (tone == shared::kToneReinhard) {  // Reinhard et al. 2002, Eq. 4
        const double x = c.reinhard_scale * y;
        d = x * (1 + x * c.reinhard_white) / (1 + x);
    } else if (tone == shared::kToneLinear) {
        d = (y - c.linear_low) * c.linear_gain;
    }
    return std::clamp(d, 0.0, 1.0);
}

/// Displayed light of a scene colour: the colour at the mapped luminance, no channel negative, and where one would
/// exceed white the colour moved towards the grey of the mapped luminance. Non-finite pixels are black.
inline dvec3 displayed(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c, double display_low, double display_high) {
    if (!finite(rgb)) return dvec3(0);
    if (tone == shared::kToneLdr) return glm::clamp(rgb, 0.0, 1.0);
    const double y = luminance(rgb);
    if (!(y > 0)) return dvec3(0);
    const double d = tone_mapped(y, tone, c, display_low, display_high);
    const dvec3 colour = glm::max(rgb / y * d, dvec3(0));
    const double most = std::max({colour.x, colour.y, colour.z});
    if (!(most > 1)) return colour;
    if (d >= 1) return dvec3(1);
    return d + (colour - d) * (1 - d) / (most - d);
}

/// Bilinear look-up at texel coordinates where 0 is the middle of the first texel, clamped at the border.
template <class Rgb>
dvec3 bilinear(std::span<const Rgb> image, uint32_t width, uint32_t height, dvec2 at) {
    const dvec2 p = glm::clamp(at, dvec2(0), dvec2(width - 1.0, height - 1.0)), low = glm::floor(p), f = p - low;
    const auto texel = [&](double x, double y) {
        const auto& t = image[size_t(std::min(y, height - 1.0)) * width + size_t(std::min(x, width - 1.0))];
        return dvec3(t.x, t.y, t.z);
    };
    return glm::mix(glm::mix(texel(low.x, low.y), texel(low.x + 1, low.y), f.x),
                    glm::mix(texel(low.x, low.y + 1), texel(low.x + 1, low.y + 1), f.x), f.y);
}

/// Code of displayed light, in [0, 255], not yet rounded.
inline dvec3 code(dvec3 shown, double inverse_gamma) {
    return 255.0 * glm::pow(glm::clamp(shown, 0.0, 1.0), dvec3(inverse_gamma));
}

/// What the composite needs beside the scene. The glares may be absent.
template <class Rgb>
struct CompositeFrame {
    std::span<const Rgb> scene;            ///< cd/m^2
    std::span<const Rgb> luminance_glare;  ///< cd/m^2, full size
    std::span<const Rgb> ldr_glare;        ///< displayed light, a quarter of the size
};

/// Unrounded codes of one pixel.
template <class Rgb>
dvec3 composite(const CompositeFrame<Rgb>& frame, shared::uvec2 pixel, uint32_t tone, const shared::ToneCurve& curve,
                const shared::CompositePush& p) {
    const auto load = [&](std::span<const Rgb> image) {
        const auto& t = image[size_t(pixel.y) * p.size.x + pixel.x];
        return dvec3(t.x, t.y, t.z);
    };
    dvec3 light = load(frame.scene);
    if (!frame.luminance_glare.empty()) light += load(frame.luminance_glare);
    dvec3 shown = displayed(light, tone, curve, p.display_low, p.display_high);
    if (!frame.ldr_glare.empty()) {
        const double shrink = shared::kGlareShrink;
        const uint32_t width = (p.size.x + shared::kGlareShrink - 1) / shared::kGlareShrink;
        const uint32_t height = (p.size.y + shared::kGlareShrink - 1) / shared::kGlareShrink;
        shown += double(p.ldr_glare) * bilinear(frame.ldr_glare, width, height, (dvec2(pixel) + 0.5) / shrink - 0.5);
    }
    return code(shown, p.inverse_gamma);
}

}  // namespace vesper::reference
