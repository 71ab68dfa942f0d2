// From scene luminance to display codes, one pixel after another. SPDX-License-Identifier: MIT
// Displayed light is relative: 0 at the display's darkest luminance, 1 at its brightest.
#pragma once

#include "passes/pyramid_reference.h"
#include "perception/display.h"
#include "shared/composite.h"

namespace vesper::reference {

/// Luminance of a code V in [0, 1], cd/m^2 (Mantiuk, Daly and Kerofsky 2008): (peak - black) V^gamma + black + k E /
/// pi.
inline double display_luminance(double code, double peak, double black, double gamma, double ambient,
                                double reflection) {
    return (peak - black) * std::pow(code, gamma) + black + reflection * ambient / 3.14159265358979323846;
}

/// A node of the table between its nodes.
inline dvec4 node_at(double y, const shared::ToneCurve& c) {
    const double t = std::clamp((std::log(std::max(y, kFloor)) - c.ln_low) * double(c.bins_per_ln), 0.0, double(c.bins));
    const uint32_t i = std::min(uint32_t(t), uint32_t(c.bins) - 1);
    return glm::mix(dvec4(c.node[i]), dvec4(c.node[i + 1]), t - i);
}

/// Displayed luminance of a scene luminance, relative, for the operators that map luminance.
inline double tone_mapped(double y, uint32_t tone, const shared::ToneCurve& c, double display_low,
                          double display_high) {
    double d = 0;
    const uint32_t form = tone & shared::kToneForm;
    if (form == shared::kToneCurve || form == shared::kToneColour) {
        d = (std::exp(node_at(y, c).x) - display_low) / (display_high - display_low);
    } else if (form == shared::kToneReinhard) {  // Reinhard et al. 2002, Eq. 4
        const double x = c.reinhard_scale * y;
        d = x * (1 + x * c.reinhard_white) / (1 + x);
    } else if (form == shared::kToneLinear || form == shared::kToneRods) {
        d = (y - c.linear_low) * c.linear_gain;
    }
    return std::clamp(d, 0.0, 1.0);
}

/// What is seen of a pixel, cd/m^2: what rods see added as grey (Ferwerda et al. 1996, Eq. 12); colour lost between 5.62
/// and 0.00562 cd/m^2 (Ward Larson et al. 1997), and luminance weighted as rods do.
inline dvec3 perceived(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c) {
    const auto scotopic = [](dvec3 p) { return 0.062 * p.x + 0.608 * p.y + 0.330 * p.z; };
    if ((tone & shared::kToneForm) == shared::kToneRods) rgb += scotopic(rgb) * dvec3(c.rods);
    const bool loss = tone & shared::kToneColourLoss, purkinje = tone & shared::kTonePurkinje;
    const double y = luminance(rgb);
    if ((tone & shared::kToneForm) == shared::kToneLdr || !(loss || purkinje) || !(y > 0)) return rgb;
    const double cones = std::clamp((y - 0.00562) / (5.62 - 0.00562), 0.0, 1.0), grey = std::max(purkinje ? scotopic(rgb) : y, 0.0);
    return loss ? cones * rgb + (1 - cones) * dvec3(grey) : rgb * ((cones * y + (1 - cones) * grey) / y);
}

/// From linear Rec. 709 to a display's primaries: the same XYZ (Lindbloom, "RGB/XYZ matrices").
inline glm::dmat3 from_rec709(const Primaries& to) {
    const auto to_xyz = [](const Primaries& p) {
        const auto xyz = [](dvec2 c) { return dvec3(c.x / c.y, 1, (1 - c.x - c.y) / c.y); };
        const glm::dmat3 m(xyz(p.red), xyz(p.green), xyz(p.blue));
        const dvec3 s = glm::inverse(m) * xyz(p.white);
        return glm::dmat3(m[0] * s.x, m[1] * s.y, m[2] * s.z);
    };
    return glm::inverse(to_xyz(to)) * to_xyz(kRec709);
}

/// Pattanaik et al. 2000, Eq. 19: ratios, of at least 1e-6, to a power; grey as pfstmo mixes it.
inline dvec3 faded(dvec3 ratios, dvec4 node) {
    for (int k = 0; k < 3; ++k) ratios[k] = node.z * std::pow(std::max(ratios[k], 1e-6), node.y) + 1 - node.z;
    return ratios;
}

/// Displayed light of a scene colour: the colour at the mapped luminance, no channel negative, and where one would
/// exceed white the colour moved towards the grey of the mapped luminance. Non-finite pixels are black. `to_own` gives
/// the colour in the display's primaries.
inline dvec3 displayed(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c, double display_low, double display_high,
                       const glm::dmat3& to_own = glm::dmat3(1)) {
    if (!finite(rgb)) return dvec3(0);
    rgb = perceived(rgb, tone, c);
    if ((tone & shared::kToneForm) == shared::kToneLdr) return glm::clamp(to_own * rgb, 0.0, 1.0);
    const double y = luminance(rgb);
    if (!(y > 0)) return dvec3(0);
    const double d = tone_mapped(y, tone, c, display_low, display_high);
    const dvec3 ratios = to_own * rgb / y;
    const dvec3 colour = d * ((tone & shared::kToneForm) == shared::kToneColour ? faded(ratios, node_at(y, c)) : glm::max(ratios, dvec3(0)));
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

/// Signal in [0, 1] for which a display emits a luminance, cd/m^2: the transfer functions as their standards give the
/// inverse. A table is searched.
inline double signal_of(double luminance, const Display& display) {
    const double black = double(display.black), peak = double(display.peak), light = std::clamp((luminance - black) / (peak - black), 0.0, 1.0);
    switch (display.eotf) {
        case Eotf::Gamma: return std::pow(light, 1 / double(display.gamma));
        case Eotf::Srgb: return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
        case Eotf::Pq: {  // ST 2084, 5.2
            const double y = std::pow(std::clamp(luminance, black, peak) / 10000, 0.1593017578125);
            return std::pow((0.8359375 + 18.8515625 * y) / (1 + 18.6875 * y), 78.84375);
        }
        case Eotf::Table: break;
    }
    const DisplayCurve curve(display);
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) (curve.emitted((low + high) / 2) < luminance ? low : high) = (low + high) / 2;
    return high;
}

/// Codes of displayed light, not yet rounded.
inline dvec3 code(dvec3 shown, const Display& display) {
    dvec3 codes;
    for (int c = 0; c < 3; ++c)
        codes[c] = display.largest_code() * signal_of(double(display.black) + (double(display.peak) - double(display.black)) * std::clamp(shown[c], 0.0, 1.0), display);
    return codes;
}

/// What the composite needs beside the scene. The glares may be absent.
template <class Rgb>
struct CompositeFrame {
    std::span<const Rgb> scene;            ///< cd/m^2
    std::span<const Rgb> luminance_glare;  ///< cd/m^2, full size
    std::span<const Rgb> ldr_glare;        ///< displayed light, a quarter of the size
    shared::uvec2 size;                    ///< px
    double gain = 1;                       ///< of the LDR glare
};

/// Unrounded codes of one pixel.
template <class Rgb>
dvec3 composite(const CompositeFrame<Rgb>& frame, shared::uvec2 pixel, uint32_t tone, const shared::ToneCurve& curve,
                const Display& display) {
    const auto load = [&](std::span<const Rgb> image) {
        const auto& t = image[size_t(pixel.y) * frame.size.x + pixel.x];
        return dvec3(t.x, t.y, t.z);
    };
    dvec3 light = load(frame.scene);
    if (!frame.luminance_glare.empty()) light += load(frame.luminance_glare);
    const glm::dmat3 to_own = from_rec709(display.primaries);
    dvec3 shown = displayed(light, tone, curve, double(display.low()), double(display.high()), to_own);
    if (!frame.ldr_glare.empty()) {
        const double shrink = shared::kGlareShrink;
        const uint32_t width = (frame.size.x + shared::kGlareShrink - 1) / shared::kGlareShrink;
        const uint32_t height = (frame.size.y + shared::kGlareShrink - 1) / shared::kGlareShrink;
        shown += to_own * (frame.gain * bilinear(frame.ldr_glare, width, height, (dvec2(pixel) + 0.5) / shrink - 0.5));
    }
    return code(shown, display);
}

/// What the display would show of a scene colour without its limits, cd/m^2: colour keeps its ratios.
inline dvec3 display_light(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c, const Display& display) {
    const double low = double(display.low()), range = double(display.high()) - low;
    const uint32_t form = tone & shared::kToneForm;
    if (form == shared::kToneLdr) return low + range * displayed(rgb, tone, c, low, low + range);
    if (!finite(rgb)) return dvec3(low);
    rgb = perceived(rgb, tone, c);
    const double y = luminance(rgb);
    if (!(y > 0)) return dvec3(low);
    const double x = c.reinhard_scale * y;
    const double d = form == shared::kToneReinhard                                    ? x * (1 + x * c.reinhard_white) / (1 + x)
                     : form == shared::kToneLinear || form == shared::kToneRods ? std::max((y - c.linear_low) * c.linear_gain, 0.0)
                                                                                      : std::max((std::exp(node_at(y, c).x) - low) / range, 0.0);
    return low + range * d * (form == shared::kToneColour ? faded(rgb / y, node_at(y, c)) : rgb / y);
}

}  // namespace vesper::reference
