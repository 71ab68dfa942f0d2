// Adaptation luminance and tone curve from the frame's statistics. SPDX-License-Identifier: MIT
// Histogram adjustment: Ward Larson, Rushmeier and Piatko 1997, solved exactly for given ceilings; thresholds of
// Ferwerda, Pattanaik, Shirley and Greenberg 1996 (cones); Reinhard, Stark, Shirley and Ferwerda 2002 (global).
#pragma once

#include <numeric>
#include <vector>

#include "passes/pyramid_reference.h"
#include "shared/tone.h"

namespace vesper::reference {

/// Threshold versus intensity of the cones, cd/m^2, with the published break points (Ferwerda et al. 1996).
inline double cone_threshold(double luminance) {
    const double l = std::log10(luminance);
    if (l <= -2.6) return std::pow(10, -0.72);
    if (l < 1.9) return std::pow(10, std::pow(0.249 * l + 0.65, 2.7) - 0.72);
    return std::pow(10, l - 1.255);
}

/// Fractions of the votes per bin, with 1e-4 of them spread evenly from the first to the last occupied bin, so that
/// what the foveal texels average away does not land on a plateau.
inline std::vector<double> fractions(const shared::Histogram& histogram, uint32_t bins) {
    std::vector<double> h(bins, 0.0);
    uint32_t first = bins, last = 0;
    for (uint32_t i = 0; i < bins; ++i)
        if (histogram.count[i] != 0) first = std::min(first, i), last = i;
    if (histogram.finite == 0 || first == bins) return h;
    constexpr double kSpread = 1e-4;
    for (uint32_t i = first; i <= last; ++i)
        h[i] = (histogram.count[i] / double(histogram.finite) + kSpread / (last - first + 1)) / (1 + kSpread);
    return h;
}

/// Slopes d ln Ld / d ln L per bin.
struct Slopes {
    std::vector<double> s;
    double slack = 0;    ///< what is left of the display's range, ln
    bool under = false;  ///< all slopes are at their ceilings
};

/// s_i = min(lambda h_i, c_i) with sum s_i delta = range: the fixed point of Ward's clipping (1997, section 4.4) for
/// given ceilings c. Exact: bins reach their ceilings in the order of c_i / h_i.
inline Slopes fill(const std::vector<double>& h, const std::vector<double>& c, double delta, double range) {
    Slopes out{std::vector<double>(h.size(), 0.0), 0, false};
    std::vector<size_t> order;
    for (size_t i = 0; i < h.size(); ++i)
        if (h[i] > 0) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return c[a] / h[a] < c[b] / h[b]; });

    std::vector<double> free(order.size() + 1, 0.0);  // sum of h over the bins from the k-th on
    for (size_t k = order.size(); k-- > 0;) free[k] = free[k + 1] + h[order[k]];
    double clipped = 0, lambda = 0;
    out.under = true;
    for (size_t k = 0; k < order.size() && out.under; ++k) {
        const size_t i = order[k];
        lambda = (range / delta - clipped) / free[k];
        if (lambda * h[i] <= c[i])
            out.under = false;
        else
            clipped += c[i];
    }
    for (size_t i : order) out.s[i] = out.under ? c[i] : std::min(lambda * h[i], c[i]);
    if (out.under) out.slack = range - delta * clipped;
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

/// The tone curve of a steady-state viewer and what it was left with.
struct Adjusted {
    Curve curve;
    double slack = 0;
    bool under = false;
};

/// Histogram adjustment, Ward et al. 1997: dLd / dL <= T(Ld) / T(L), with T of the cones on both sides.
inline Adjusted adjust(const std::vector<double>& h, double adaptation, const shared::AdaptPush& p) {
    constexpr int kIterations = 24;
    const double delta = 1 / double(p.bins_per_ln), low = std::log(double(p.display_low));
    const double range = std::log(double(p.display_high)) - low;
    const size_t bins = h.size();
    Adjusted out{{p.ln_low, p.bins_per_ln, std::vector<double>(bins + 1, low)}, 0, false};
    if (std::accumulate(h.begin(), h.end(), 0.0) == 0) return out;

    std::vector<double>& node = out.curve.node;
    for (size_t i = 0; i < bins; ++i) node[i + 1] = node[i] + range * h[i];  // plain histogram equalisation
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        std::vector<double> ceiling(bins);
        for (size_t i = 0; i < bins; ++i) {
            const double scene = std::exp(p.ln_low + (double(i) + 0.5) * delta);
            const double shown = std::exp((node[i] + node[i + 1]) / 2);
            ceiling[i] = (cone_threshold(shown) / shown) / (cone_threshold(scene) / scene);
        }
        const Slopes slopes = fill(h, ceiling, delta, range);
        Curve next{p.ln_low, p.bins_per_ln, std::vector<double>(bins + 1, low)};
        for (size_t i = 0; i < bins; ++i) next.node[i + 1] = next.node[i] + slopes.s[i] * delta;
        if (slopes.under) {
            // The whole curve moves so that the adaptation luminance is as visible as on a display half as bright as
            // white (Ferwerda et al. 1996), as far as the display allows.
            const double shown = p.display_high / 2.0;
            const double want = std::log(adaptation * cone_threshold(shown) / cone_threshold(adaptation));
            const double offset = std::clamp(want - next.at(std::log(adaptation)), 0.0, slopes.slack);
            for (double& y : next.node) y += offset;
        }
        for (size_t i = 0; i <= bins; ++i) node[i] = (node[i] + next.node[i]) / 2;
        out.slack = slopes.slack, out.under = slopes.under;
    }
    return out;
}

/// Everything the pass writes.
struct Adapted {
    Adjusted adjusted;
    shared::ToneCurve tone{};
    shared::EyeState eye{};
};

/// `top` is the 1x1 level of the pyramid.
inline Adapted adapt(const shared::Histogram& histogram, dvec4 top, shared::EyeState previous,
                     const shared::AdaptPush& p) {
    Adapted out;
    const bool empty = histogram.finite == 0;
    const double log_average = empty ? kFloor : std::max(std::exp(top.z), kFloor), maximum = empty ? 0.0 : top.w;
    out.adjusted = adjust(fractions(histogram, p.bins), log_average, p);

    shared::ToneCurve& t = out.tone;
    t.adaptation = t.log_average = float(log_average);
    t.maximum = float(maximum);
    const double scale = p.key / log_average;  // Reinhard et al. 2002, Eq. 2 and 4
    const double white = scale * (p.white > 0 ? double(p.white) : std::max(maximum, kFloor));
    t.reinhard_scale = float(scale);
    t.reinhard_white = float(1 / (white * white));
    const double high = p.linear_high != 0 ? double(p.linear_high) : maximum;
    t.linear_low = p.linear_low;
    t.linear_gain = float(1 / std::max(high - p.linear_low, kFloor));
    t.ln_low = p.ln_low, t.bins_per_ln = p.bins_per_ln, t.bins = float(p.bins);
    t.ceiling = out.adjusted.under ? 1.0f : 0.0f;
    t.slack = float(out.adjusted.slack);
    for (size_t i = 0; i <= p.bins; ++i) t.node[i] = float(out.adjusted.curve.node[i]);
    out.eye = {float(log_average), previous.seconds + p.seconds};
    return out;
}

}  // namespace vesper::reference
