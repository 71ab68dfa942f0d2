// From scene luminance to display codes, one pixel after another. SPDX-License-Identifier: MIT
// Displayed light is relative: 0 at the display's darkest luminance, 1 at its brightest.
#pragma once

#include "passes/operators/operator_reference.h"
#include "shared/bloom.h"
#include "shared/composite.h"
#include "shared/gamut.h"
#include "vision/display.h"
#include "vision/thresholds.h"

namespace vesper::reference {

/// Luminance of a code V in [0, 1], cd/m^2 (Mantiuk, Daly and Kerofsky 2008): (peak - black) V^gamma + black + k E /
/// pi.
inline double display_luminance(double code, double peak, double black, double gamma, double ambient,
                                double reflection) {
    return (peak - black) * std::pow(code, gamma) + black + reflection * ambient / 3.14159265358979323846;
}

/// A node of the table between its nodes.
inline dvec4 node_at(double y, const shared::ToneCurve& c) {
    const double t =
        std::clamp((std::log(std::max(y, kFloor)) - c.ln_low) * double(c.bins_per_ln), 0.0, double(c.bins));
    const uint32_t i = std::min(uint32_t(t), uint32_t(c.bins) - 1);
    return glm::mix(dvec4(c.node[i]), dvec4(c.node[i + 1]), t - i);
}

/// What rods see of a colour over what they see of white (Ward Larson et al. 1997); or its luminance.
inline double scotopic(dvec3 rgb, uint32_t tone) {
    if (tone & shared::kTonePhotopicRods) return luminance(rgb);
    const glm::dmat3 xyz = glm::transpose(
        glm::dmat3(0.412391, 0.357584, 0.180481, 0.212639, 0.715169, 0.072192, 0.019331, 0.119195, 0.950532));
    const dvec3 c = xyz * glm::max(rgb, dvec3(0));
    return vision::scotopic_luminance(c.x, c.y, c.z) / vision::scotopic_luminance(0.950456, 1, 1.089058);
}

/// Displayed luminance of a scene colour, relative, before the display's limits.
inline double tone_mapped(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c, double display_low,
                          double display_high) {
    const double y = std::max(luminance(rgb), 0.0), low = c.block[0].x, gain = c.block[0].y;
    switch (tone & shared::kToneForm) {
        case shared::kToneCurve:
            return (std::exp(node_at(y, c).x) - display_low) / (display_high - display_low);
        case shared::kToneReinhard:
            return low * y * (1 + low * y * gain) / (1 + low * y);  // Reinhard et al. 2002, Eq. 4
        case shared::kToneColour: {                                 // Pattanaik et al. 2000, Eq. 13
            const double r = std::clamp(node_at(y, c).x + node_at(scotopic(rgb, tone), c).z + low, 0.0, 0.9999999);
            return std::min(gain * std::pow(r / (1 - r), 1 / 0.73), 1000.0);
        }
        case shared::kToneLinear:
        case shared::kToneRods:
            return (y - low) * gain;
        default:
            return y;  // of an operator that maps colours
    }
}

/// Of grey, within the display's limits.
inline double tone_mapped(double y, uint32_t tone, const shared::ToneCurve& c, double display_low,
                          double display_high) {
    return std::clamp(tone_mapped(dvec3(y), tone, c, display_low, display_high), 0.0, 1.0);
}

/// What is seen of a pixel, cd/m^2: what rods see added as grey (Ferwerda et al. 1996, Eq. 12); colour lost
/// between 5.62 and 0.00562 cd/m^2 (Ward Larson et al. 1997), and luminance weighted as rods do.
inline dvec3 perceived(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c) {
    if ((tone & shared::kToneForm) == shared::kToneRods) {
        const dvec3 grey = scotopic(rgb, tone) * dvec3(c.block[1]);
        rgb = dvec3(glm::dot(dvec3(c.block[2]), rgb), glm::dot(dvec3(c.block[3]), rgb),
                    glm::dot(dvec3(c.block[4]), rgb)) +
              grey;
    }
    const bool loss = tone & shared::kToneColourLoss, purkinje = tone & shared::kTonePurkinje;
    const double y = luminance(rgb);
    if ((tone & shared::kToneForm) == shared::kToneLdr || !(loss || purkinje) || !(y > 0)) return rgb;
    const double cones = std::clamp((y - 0.00562) / (5.62 - 0.00562), 0.0, 1.0),
                 grey = std::max(purkinje ? scotopic(rgb, tone) : y, 0.0);
    return loss ? cones * rgb + (1 - cones) * dvec3(grey) : rgb * ((cones * y + (1 - cones) * grey) / y);
}

/// The light that an operator which maps colours shows of a finite pixel.
inline dvec3 colour_mapped(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c) {
    const auto found = operator_references().find(render::Operator(tone & shared::kToneForm));
    const bool maps = found != operator_references().end() && found->second.rgb && std::isfinite(luminance(rgb));
    return maps ? found->second.rgb(c, rgb) : rgb;
}

/// From linear Rec. 709 to a display's primaries: the same XYZ (Lindbloom, "RGB/XYZ matrices").
inline glm::dmat3 from_rec709(const io::Primaries& to) {
    const auto to_xyz = [](const io::Primaries& p) {
        const auto xyz = [](dvec2 c) { return dvec3(c.x / c.y, 1, (1 - c.x - c.y) / c.y); };
        const glm::dmat3 m(xyz(p.red), xyz(p.green), xyz(p.blue));
        const dvec3 s = glm::inverse(m) * xyz(p.white);
        return glm::dmat3(m[0] * s.x, m[1] * s.y, m[2] * s.z);
    };
    return glm::inverse(to_xyz(to)) * to_xyz(io::kRec709);
}

/// Colour of a pixel at displayed luminance d: ratios are kept; with Pattanaik et al. 2000 (Eq. 19) the nearest of the
/// same luminance and hue line that are 0.01 at least are raised to a power, and mixed with grey as pfstmo does.
inline dvec3 coloured(dvec3 rgb, dvec3 own, double d, uint32_t tone, const shared::ToneCurve& c) {
    const double y = luminance(rgb);
    if (!(y > 0)) return dvec3(d);
    dvec3 ratios = own / y;
    if ((tone & shared::kToneForm) == shared::kToneColour) {
        const dvec4 node = node_at(y, c);
        const double rods = node_at(scotopic(rgb, tone), c).z, share = node.x / std::max(node.x + rods, 1e-30);
        const double least = std::min({ratios.x, ratios.y, ratios.z});
        if (least < 0.01) ratios = glm::max(glm::mix(ratios, dvec3(1), (0.01 - least) / (1 - least)), dvec3(0.01));
        for (int k = 0; k < 3; ++k) ratios[k] = share * std::pow(ratios[k], node.y) + 1 - share;
    }
    return d * ratios;
}

/// Oklab of linear Rec. 709 and back (Ottosson 2020), for another white than (1, 1, 1) after von Kries.
struct Oklab {
    glm::dmat3 cones = glm::transpose(glm::dmat3(0.4122214708, 0.5363325363, 0.0514459929, 0.2119034982, 0.6806995451,
                                                 0.1073969566, 0.0883024619, 0.2817188376, 0.6299787005));
    glm::dmat3 lab = glm::transpose(glm::dmat3(0.2104542553, 0.7936177850, -0.0040720468, 1.9779984951, -2.4285922050,
                                               0.4505937099, 0.0259040371, 0.7827717662, -0.8086757660));
    dvec3 white{1};

    dvec3 of(dvec3 rgb) const {
        const dvec3 c = cones * rgb / (cones * white);
        return lab * dvec3(std::cbrt(c.x), std::cbrt(c.y), std::cbrt(c.z));
    }
    dvec3 rgb(dvec3 of) const {
        const dvec3 root = glm::inverse(lab) * of;
        return glm::inverse(cones) * (root * root * root * (cones * white));
    }
};

/// Displayed light, Rec. 709, within the display's primaries, that is brighter than the display in its colour: chroma
/// goes down from where its largest channel comes near 1, with luminance, at that of white by 0.2 and half of the
/// luminance that it has itself, at the hue and with the largest channel that can be.
inline dvec3 towards_white(dvec3 light, const glm::dmat3& to_own) {
    const auto largest = [&](dvec3 rgb) {
        const dvec3 own = to_own * rgb;
        return std::max({own.x, own.y, own.z});
    };
    if (!(luminance(light) > 0)) return light;
    const dvec3 colour = light / luminance(light);
    const double x = largest(light) / std::max(luminance(light), 1.0), most = largest(colour),
                 knee = std::min(0.15, most - 1);
    if (x <= 1 - knee) return light / std::max(luminance(light), 1.0);
    // max(x, 1) averaged over a knee to either side: where it is, and what of x is left.
    const double above = x >= 1 + knee ? x : 1 + (x - 1 + knee) * (x - 1 + knee) / (4 * knee);
    const Oklab oklab{.white = glm::inverse(to_own) * dvec3(1)};
    const double kept = 1 - (0.2 + 0.5 / most) * std::min((most - 1) / 0.3, 1.0) * (above - 1) / (most - 1);
    const dvec3 faded = to_own * oklab.rgb(oklab.of(colour) * dvec3(1, kept, kept));
    const dvec3 inside = glm::max(faded, dvec3(0));
    return glm::inverse(to_own) * (inside / std::max({inside.x, inside.y, inside.z}) * (1 + x - above));
}

/// Displayed light of a scene colour: the colour at the mapped luminance. Where a channel is negative the colour goes
/// towards the grey of that luminance until it is 0; where one exceeds 1, `tone` says what gives way. Non-finite pixels
/// are black. `to_own` gives the colour in the display's primaries.
inline dvec3 displayed(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c, double display_low, double display_high,
                       const glm::dmat3& to_own = glm::dmat3(1)) {
    if (!finite(rgb)) return dvec3(0);
    rgb = colour_mapped(perceived(rgb, tone, c), tone, c);
    if ((tone & shared::kToneForm) == shared::kToneLdr) return glm::clamp(to_own * rgb, 0.0, 1.0);
    const double d = std::clamp(tone_mapped(rgb, tone, c, display_low, display_high), 0.0, 1.0);
    dvec3 colour = coloured(rgb, to_own * rgb, d, tone, c);
    if ((tone & shared::kGamutMask) == shared::kGamutClip) return glm::clamp(colour, 0.0, 1.0);
    const double least = std::min({colour.x, colour.y, colour.z});
    if (least < 0) colour = glm::max(glm::mix(dvec3(d), colour, d / (d - least)), dvec3(0));
    if ((tone & shared::kGamutMask) == shared::kGamutChromaticity)
        return colour / std::max({colour.x, colour.y, colour.z, 1.0});
    return to_own * towards_white(glm::inverse(to_own) * colour, to_own);
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
inline double signal_of(double luminance, const vision::Display& display) {
    const double black = double(display.black), peak = double(display.peak),
                 light = std::clamp((luminance - black) / (peak - black), 0.0, 1.0);
    switch (display.eotf) {
        case vision::Eotf::Gamma:
            return std::pow(light, 1 / double(display.gamma));
        case vision::Eotf::Srgb:
            return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
        case vision::Eotf::Pq: {  // ST 2084, 5.2
            const double y = std::pow(std::clamp(luminance, black, peak) / 10000, 0.1593017578125);
            return std::pow((0.8359375 + 18.8515625 * y) / (1 + 18.6875 * y), 78.84375);
        }
        case vision::Eotf::Table:
            break;
    }
    const vision::DisplayCurve curve(display);
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) (curve.emitted((low + high) / 2) < luminance ? low : high) = (low + high) / 2;
    return high;
}

/// Codes of displayed light, not yet rounded.
inline dvec3 code(dvec3 shown, const vision::Display& display) {
    dvec3 codes;
    for (int c = 0; c < 3; ++c)
        codes[c] =
            display.largest_code() * signal_of(double(display.black) + (double(display.peak) - double(display.black)) *
                                                                           std::clamp(shown[c], 0.0, 1.0),
                                               display);
    return codes;
}

/// What the composite needs beside the scene. The bloom may be absent.
template <class Rgb>
struct CompositeFrame {
    std::span<const Rgb> scene;  ///< cd/m^2
    std::span<const Rgb> bloom;  ///< displayed light, a quarter of the size
    shared::uvec2 size;          ///< px
    double gain = 1;             ///< of the bloom
};

/// Displayed light of one pixel.
template <class Rgb>
dvec3 composite_light(const CompositeFrame<Rgb>& frame, shared::uvec2 pixel, uint32_t tone,
                      const shared::ToneCurve& curve, const vision::Display& display) {
    const auto& texel = frame.scene[size_t(pixel.y) * frame.size.x + pixel.x];
    const dvec3 light(texel.x, texel.y, texel.z);
    const glm::dmat3 to_own = from_rec709(display.primaries);
    dvec3 shown = displayed(light, tone, curve, double(display.low()), double(display.high()), to_own);
    if (!frame.bloom.empty()) {
        constexpr uint32_t kShrink = 4;  // px of a block of bloom
        const uint32_t width = (frame.size.x + kShrink - 1) / kShrink;
        const uint32_t height = (frame.size.y + kShrink - 1) / kShrink;
        shown +=
            to_own * (frame.gain * bilinear(frame.bloom, width, height, (dvec2(pixel) + 0.5) / double(kShrink) - 0.5));
    }
    return shown;
}

/// Unrounded codes of one pixel.
template <class Rgb>
dvec3 composite(const CompositeFrame<Rgb>& frame, shared::uvec2 pixel, uint32_t tone, const shared::ToneCurve& curve,
                const vision::Display& display) {
    return code(composite_light(frame, pixel, tone, curve, display), display);
}

/// What the display would show of a scene colour without its limits, cd/m^2: colour keeps its ratios.
inline dvec3 display_light(dvec3 rgb, uint32_t tone, const shared::ToneCurve& c, const vision::Display& display) {
    const double low = double(display.low()), range = double(display.high()) - low;
    const uint32_t form = tone & shared::kToneForm;
    if (form == shared::kToneLdr) return low + range * displayed(rgb, tone, c, low, low + range);
    if (!finite(rgb)) return dvec3(low);
    rgb = colour_mapped(perceived(rgb, tone, c), tone, c);
    return low + range * coloured(rgb, rgb, std::max(tone_mapped(rgb, tone, c, low, low + range), 0.0), tone, c);
}

}  // namespace vesper::reference
