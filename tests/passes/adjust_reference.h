// Histogram adjustment by trimming, and what the anchored one shares with it; in double. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "shared/tone.h"
#include "vision/eye.h"

namespace vesper::reference {

inline std::vector<double> shares(const shared::Histogram& histogram, uint32_t bins) {
    std::vector<double> h(bins, 0.0);
    for (uint32_t i = 0; i < bins && histogram.votes; ++i) h[i] = histogram.count[i] / double(histogram.votes);
    return h;
}

/// Shares per step of the curve: bins seen through a window, a cubic B-spline whose knots are `window` bins apart, of
/// which the steps take the values in their middles. Whole votes (0): a bin is a step.
inline std::vector<double> per_step(const std::vector<double>& share, const shared::ToneParameters& p) {
    if (p.window == 0) return share;
    std::vector<double> out(share.size() * p.steps_per_bin, 0.0);
    double sum = 0;
    for (size_t i = 0; i < out.size(); ++i) {
        for (size_t bin = 0; bin < share.size(); ++bin) {
            const double u = std::abs((double(i) + 0.5) / p.steps_per_bin - (double(bin) + 0.5)) / double(p.window);
            out[i] += share[bin] * (u < 1 ? 2.0 / 3 - u * u + u * u * u / 2 : u < 2 ? std::pow(2 - u, 3) / 6 : 0);
        }
        sum += out[i];
    }
    const double all = std::accumulate(share.begin(), share.end(), 0.0);
    for (double& x : out) x *= sum > 0 ? all / sum : 0;
    return out;
}

/// Slopes d ln Ld / d ln L per bin.
struct Slopes {
    std::vector<double> s;
    double slack = 0;    ///< what is left of the display's range, ln
    bool under = false;  ///< all slopes are at their ceilings
};

/// s_i = min(lambda h_i, c_i) with sum s_i delta = range: the fixed point of Ward's clipping (1997, section 4.4) for
/// given ceilings c. Exact: bins reach their ceilings in the order of c_i / h_i. lambda goes no higher than `limit`;
/// where that does not fill the range, something is left over.
inline Slopes fill(const std::vector<double>& h, const std::vector<double>& c, double delta, double range,
                   double limit) {
    Slopes out{std::vector<double>(h.size(), 0.0), 0, false};
    std::vector<size_t> order;
    for (size_t i = 0; i < h.size(); ++i)
        if (h[i] > 0) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return c[a] / h[a] < c[b] / h[b]; });

    std::vector<double> free(order.size() + 1, 0.0);  // sum of h over the bins from the k-th on
    for (size_t k = order.size(); k-- > 0;) free[k] = free[k + 1] + h[order[k]];
    double clipped = 0, lambda = limit;
    for (size_t k = 0; k < order.size(); ++k) {
        const size_t i = order[k];
        lambda = (range / delta - clipped) / free[k];
        if (lambda * h[i] <= c[i]) break;
        clipped += c[i];
        lambda = limit;
    }
    out.under = lambda >= limit;
    lambda = std::min(lambda, limit);
    double filled = 0;
    for (size_t i : order) out.s[i] = std::min(lambda * h[i], c[i]), filled += out.s[i] * delta;
    if (out.under) out.slack = std::max(range - filled, 0.0);
    return out;
}

/// A tone curve in double: ln of display luminance at the edges of the bins.
struct Curve {
    double ln_low = 0, bins_per_ln = 1;
    std::vector<double> node;

    double at(double ln_luminance) const {
        const double last = double(node.size()) - 1;
        const double t = std::clamp((ln_luminance - ln_low) * bins_per_ln, 0.0, last);
        const size_t i = std::min(size_t(t), node.size() - 2);
        return node[i] + (node[i + 1] - node[i]) * (t - double(i));
    }
};

/// A tone curve, and what is left of the display.
struct Adjusted {
    Curve curve;
    double slack = 0;    ///< ln of the part of the display's range above the curve
    bool under = false;  ///< the ceilings do not fill the display; of trim(): the curve is linear
};

/// Thresholds on both sides of the ceiling, cd/m^2.
struct Thresholds {
    std::function<double(double)> scene, display;
};

inline Thresholds thresholds_of(const shared::ToneParameters& p, const vision::ReceptorModel& cones, double cone_sigma,
                                const vision::ReceptorModel& rods, double rod_sigma) {
    const vision::ThresholdBreaks breaks{p.cone_break, p.rod_break};
    const auto linear = [](double l) { return l; };
    const auto human = [=](double l) { return vision::human_threshold(l, breaks); };
    const auto adapted = [=](double l) { return vision::cone_threshold(l, breaks); };
    const auto eye = [=, &cones, &rods](double l) {
        const double t = cones.threshold(l, cone_sigma);
        return p.use_rods ? std::min(t, rods.threshold(p.scotopic * l, rod_sigma) / p.scotopic) : t;
    };
    switch (p.ceiling) {
        case shared::kCeilingLinear:
            return {linear, linear};
        case shared::kCeilingHuman:
            return {human, human};
        case shared::kCeilingCones:
            return {adapted, adapted};
        default:
            return {eye, adapted};
    }
}

/// Ward's own way, as pcond of Radiance has it (tone-mapping.md, section 3): clip counts to their ceilings, again with
/// the new total, until what is clipped is within 2.5 % of it; the curve is that before the last clip. Linear where the
/// range of the scene is no more than the display's, or hardly any counts are left; `average` is then shown at the
/// geometric middle.
inline Adjusted trim(const std::vector<double>& share, double average, const Thresholds& threshold,
                     const shared::ToneParameters& p) {
    constexpr double kTolerance = 0.025;
    const double low = std::log(double(p.display_low)), high = std::log(double(p.display_high)), range = high - low,
                 delta = 1 / (double(p.bins_per_ln) * p.steps_per_bin);
    std::vector<double> f = per_step(share, p);
    Adjusted out{{p.ln_low, 1 / delta, std::vector<double>(f.size() + 1, low)}, 0, false};
    const double original = std::accumulate(f.begin(), f.end(), 0.0);
    if (original == 0) return out;
    const auto occupied = [](double n) { return n > 0; };
    const auto first = std::find_if(share.begin(), share.end(), occupied);
    const auto last = std::find_if(share.rbegin(), share.rend(), occupied).base();
    out.under = double(last - first) / double(p.bins_per_ln) <= range;
    while (!out.under) {
        const double total = std::accumulate(f.begin(), f.end(), 0.0);
        if (total <= kTolerance * original) {
            out.under = true;
            break;
        }
        double trimmed = 0;
        for (size_t i = 0; i < f.size(); ++i) out.curve.node[i + 1] = out.curve.node[i] + range * f[i] / total;
        for (size_t i = 0; i < f.size(); ++i) {
            const double scene = std::exp(p.ln_low + (double(i) + 0.5) * delta),
                         shown = std::exp((out.curve.node[i] + out.curve.node[i + 1]) / 2);
            const double most =
                total * delta / range * (threshold.display(shown) / shown) / (threshold.scene(scene) / scene);
            if (f[i] > most) trimmed += f[i] - most, f[i] = most;
        }
        if (trimmed <= kTolerance * total) return out;
    }
    const double middle = std::exp((low + high) / 2), scale = threshold.display(middle) / threshold.scene(average);
    for (size_t i = 0; i <= f.size(); ++i)
        out.curve.node[i] = std::clamp(p.ln_low + double(i) * delta + std::log(scale), low, high);
    return out;
}

}  // namespace vesper::reference
