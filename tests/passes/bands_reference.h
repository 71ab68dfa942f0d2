// Bands of contrast of equal visibility level. SPDX-License-Identifier: MIT
// In the way of Grave and Bremond 2008, reconstructed: a Laplacian pyramid (Burt and Adelson 1983) of ln luminance, its
// contrasts shown at the same multiple of what is just seen (Ferwerda et al. 1996; on the display, adapted to 0.3 of
// white) as in the scene.
#pragma once

#include "passes/composite_reference.h"
#include "shared/tone.h"
#include "vision/thresholds.h"

namespace vesper::reference {

/// ln of display luminance, cd/m^2.
struct Bands {
    std::vector<double> shown;
    std::vector<double> terms;  ///< sum of the sizes of what is added up: what floats round
};

/// A value of a level half as fine at texel (x, y), linear between the middles of texels that have finite pixels.
template <class Value>
double expanded(const PyramidLevel& level, uint32_t x, uint32_t y, const Value& value) {
    const double u = std::clamp((x + 0.5) / 2 - 0.5, 0.0, level.width - 1.0),
                 v = std::clamp((y + 0.5) / 2 - 0.5, 0.0, level.height - 1.0);
    double sum = 0, weights = 0;
    for (uint32_t j = uint32_t(v); j <= std::min(uint32_t(v) + 1, level.height - 1); ++j)
        for (uint32_t i = uint32_t(u); i <= std::min(uint32_t(u) + 1, level.width - 1); ++i) {
            const double weight = level.at(i, j).y > 0 ? (1 - std::abs(u - i)) * (1 - std::abs(v - j)) : 0;
            sum += weight * value(size_t(j) * level.width + i), weights += weight;
        }
    return weights > 0 ? sum / weights : 0;
}

/// ln of the contrast that a viewer adapted to 0.3 of white just sees where the curve shows log average `adapted`, over
/// that which cones adapted to it just see there; at most 0, the contrast of the scene.
inline double ln_steepness(double adapted, const shared::ToneCurve& curve, const shared::ToneParameters& p) {
    const double scene = std::exp(adapted), shown = std::exp(node_at(scene, curve).x), sigma = p.viewer_sigma;
    const double on_display = double(p.viewer_step) * (shown + sigma) * (shown + sigma) / sigma;
    return std::min(std::log(on_display / shown / (vision::cone_threshold(scene, {p.cone_break, p.rod_break}) / scene)),
                    0.0);
}

/// Of pixels with `luminance`, of which `levels` is the pyramid; bands up to level `top`, 1-based.
inline Bands bands(const std::vector<double>& luminance, uint32_t width, uint32_t height,
                   const std::vector<PyramidLevel>& levels, uint32_t top, const shared::ToneCurve& curve,
                   const shared::ToneParameters& p) {
    Bands above;
    for (const dvec4& texel : levels[top - 1].texels)
        above.shown.push_back(node_at(std::exp(texel.z), curve).x), above.terms.push_back(std::abs(above.shown.back()));
    for (uint32_t k = top; k-- > 0;) {
        const PyramidLevel& coarse = levels[k];
        const uint32_t w = k > 0 ? levels[k - 1].width : width, h = k > 0 ? levels[k - 1].height : height;
        Bands here;
        for (uint32_t y = 0; y < h; ++y)
            for (uint32_t x = 0; x < w; ++x) {
                const double ln =
                    k > 0 ? levels[k - 1].at(x, y).z : std::log(std::max(luminance[size_t(y) * w + x], kFloor));
                const double adapted = expanded(coarse, x, y, [&](size_t i) { return coarse.texels[i].z; });
                const double steepness = std::exp(
                    expanded(coarse, x, y, [&](size_t i) { return ln_steepness(coarse.texels[i].z, curve, p); }));
                here.shown.push_back(std::min(
                    expanded(coarse, x, y, [&](size_t i) { return above.shown[i]; }) + (ln - adapted) * steepness,
                    std::log(1e6)));
                here.terms.push_back(expanded(coarse, x, y, [&](size_t i) { return above.terms[i]; }) +
                                     (1 + std::abs(ln) + std::abs(adapted)) * steepness);
            }
        above = std::move(here);
    }
    return above;
}

/// A pixel shown at luminance `shown`, cd/m^2: its colour as it is perceived keeps its ratios; grey where it has no
/// light.
inline dvec3 banded(dvec3 rgb, double shown, uint32_t tone, const shared::ToneCurve& curve) {
    const double y = luminance(rgb);
    return y > 0 ? perceived(rgb, tone, curve) * (shown / y) : dvec3(shown);
}

}  // namespace vesper::reference
