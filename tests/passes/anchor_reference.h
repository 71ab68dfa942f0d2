// Histogram adjustment anchored at what the eye is adapted to; in double. SPDX-License-Identifier: MIT
#pragma once

#include "passes/adjust_reference.h"

namespace vesper::reference {

/// How a viewer who is adapted to 0.3 of white sees a display: responses L / (L + sigma), and just noticeable
/// differences between the display's darkest luminance and another one. Differences with kCeilingLinear: ln of the
/// ratio.
struct Viewer {
    double sigma, step, low, high;
    bool linear;

    explicit Viewer(const shared::ToneParameters& p)
        : sigma(p.viewer_sigma),
          step(p.viewer_step),
          low(p.display_low),
          high(p.display_high),
          linear(p.ceiling == shared::kCeilingLinear) {}

    double response(double luminance) const { return luminance / (luminance + sigma); }
    double differences(double luminance) const {
        return linear ? std::log(luminance / low) : (response(luminance) - response(low)) / step;
    }
    double luminance(double differences) const {
        if (linear) return low * std::exp(differences);
        const double r = differences * step + response(low);
        return sigma * r / (1 - r);
    }
    /// Of lightness, ((L - low) / (high - low))^(1 / 2.2), by differences.
    double lightness_slope(double differences) const {
        const double l = luminance(differences), rise = linear ? l : step * (l + sigma) * (l + sigma) / sigma;
        return std::pow(std::max((l - low) / (high - low), 1e-6), 1 / 2.2 - 1) / 2.2 * rise / (high - low);
    }
};

/// The luminance to which cones of that half saturation are adapted, at least 1e-4 cd/m^2: where the threshold of
/// adapted ones overtakes theirs.
inline double adapted_luminance(double sigma, const vision::ReceptorModel& cones) {
    double low = std::log(1e-4), high = std::max(std::log(sigma), low);
    for (int k = 0; k < 100; ++k) {
        const double middle = (low + high) / 2, l = std::exp(middle);
        (cones.adapted_threshold(l) > cones.threshold(l, sigma) ? high : low) = middle;
    }
    return std::exp(low);
}

/// Where the display shows what the eye is adapted to, in differences: with the L / T(L) of the scene, up to 0.3 of
/// white.
inline double anchor(double adapted, const Thresholds& threshold, const shared::ToneParameters& p) {
    const Viewer viewer(p);
    const double t =
        viewer.linear ? vision::cone_threshold(adapted, {p.cone_break, p.rod_break}) : threshold.scene(adapted);
    const double most = viewer.differences(std::max(0.3 * viewer.high, viewer.low));
    // R (1 - R) = step L / T(L): the lesser root, that of a luminance below half saturation.
    const double product = std::min(viewer.step * adapted / t, 0.25),
                 response = (1 - std::sqrt(1 - 4 * product)) / 2 + viewer.response(viewer.low);
    return response < 0.5 ? std::min(viewer.differences(viewer.sigma * response / (1 - response)), most) : most;
}

/// `x` of `all` differences, counted from the anchor, where there is `room` for that many: a hyperbola of slope 1 at
/// the anchor.
inline double compressed(double x, double all, double room) {
    if (!(room > 0)) return 0;
    return all > room ? x / (1 + x * (1 / room - 1 / all)) : x;
}

/// Histogram adjustment, Ward et al. 1997, anchored: `adapted`, what the eye is adapted to, is as visible as in the
/// scene. In just noticeable differences, dJ = dL / T of the scene and dR / step of the display, no step of the curve
/// has more on the display than in the scene. Below the anchor the differences of the scene are compressed into those
/// of the display. Above it a step has min(n, b base + l votes): n are those of the scene, base is the same
/// compression, votes are as much lightness as their share; b and l, at most 1, are as large as fits, l before b rises
/// above 1/2. `share`: of the votes, step by step. `adapted`: cd/m^2.
inline Adjusted adjust(const std::vector<double>& share, double adapted, const Thresholds& threshold,
                       const shared::ToneParameters& p) {
    constexpr double kLeastBase = 0.5;
    const double delta = 1 / (double(p.bins_per_ln) * p.steps_per_bin);
    const size_t steps = share.size();
    const Viewer viewer(p);
    Adjusted out{{p.ln_low, 1 / delta, std::vector<double>(steps + 1, std::log(viewer.low))}, 0, false};
    if (std::accumulate(share.begin(), share.end(), 0.0) == 0) return out;

    const double at = std::clamp((std::log(adapted) - p.ln_low) / delta, 0.0, double(steps));
    std::vector<double> above(steps), below(steps);
    double all_above = 0, all_below = 0;
    for (size_t i = 0; i < steps; ++i) {
        // Simpson's rule.
        const auto visibility = [&](double at_step) {
            const double l = std::exp(p.ln_low + at_step * delta);
            return l / threshold.scene(l);
        };
        const double k = double(i), n = delta / 6 * (visibility(k) + 4 * visibility(k + 0.5) + visibility(k + 1));
        const double part = std::clamp(double(i) + 1 - at, 0.0, 1.0);
        all_above += above[i] = part * n, all_below += below[i] = (1 - part) * n;
    }

    // Between no light and the first step thresholds are constant.
    const double first = std::exp(double(p.ln_low));
    if (!viewer.linear) all_below += first / threshold.scene(first);
    // Where the eye sees fewer differences than up to the anchor, it lies lower: no light is black.
    const double start = std::min(anchor(adapted, threshold, p), all_below),
                 room = viewer.differences(viewer.high) - start;

    std::vector<double> base(steps), votes(steps);
    double counted = 0;
    for (size_t i = 0; i < steps; ++i) {
        const double from = compressed(counted, all_above, room), to = compressed(counted += above[i], all_above, room);
        base[i] = to - from;
        const double part = std::clamp(double(i) + 1 - at, 0.0, 1.0);
        votes[i] = part * share[i] /
                   std::max(viewer.lightness_slope(start + (from + to) / 2), viewer.lightness_slope(start + room));
    }
    const auto rise = [&](size_t i, double l, double b) { return std::min(above[i], b * base[i] + l * votes[i]); };
    const auto fits = [&](double l, double b) {
        double sum = 0;
        for (size_t i = 0; i < steps; ++i) sum += rise(i, l, b);
        return sum <= room;
    };
    double l = 1, b = kLeastBase;
    const double most =
        std::max(std::pow(all_above / room, 2), 1.0);  // base is nowhere less than its ceiling over that
    out.under = fits(1, most);
    if (!fits(l, b)) {
        double low = 0, high = 1;
        for (int k = 0; k < 100; ++k) (fits((low + high) / 2, b) ? low : high) = (low + high) / 2;
        l = low;
    } else if (!out.under) {
        double low = b, high = most;
        for (int k = 0; k < 100; ++k) (fits(l, (low + high) / 2) ? low : high) = (low + high) / 2;
        b = low;
    } else {
        b = most;
    }

    double j = start;
    for (size_t i = size_t(at); i < steps; ++i) out.curve.node[i + 1] = j += rise(i, l, b);
    if (out.under) out.slack = std::log(viewer.high / viewer.luminance(j));
    counted = 0;
    for (size_t i = size_t(std::ceil(at)); i > 0; --i) {
        counted += below[i - 1];
        out.curve.node[i - 1] = std::max(start - compressed(counted, all_below, start), 0.0);
    }
    if (at == std::floor(at)) out.curve.node[size_t(at)] = start;
    for (double& node : out.curve.node) node = std::log(std::clamp(viewer.luminance(node), viewer.low, viewer.high));
    return out;
}

}  // namespace vesper::reference
