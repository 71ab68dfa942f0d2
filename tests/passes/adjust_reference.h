// The tone curve of histogram adjustment: shares, ceilings, filling, trimming; in double. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "perception/eye.h"
#include "shared/tone.h"

namespace vesper::reference {

/// Shares of the votes with 1e-5 of them spread evenly over all bins, so that no part of the curve is flat.
inline std::vector<double> with_spread(std::vector<double> share) {
    constexpr double kSpread = 1e-5;
    if (std::accumulate(share.begin(), share.end(), 0.0) == 0) return share;
    for (double& s : share) s = (s + kSpread / double(share.size())) / (1 + kSpread);
    return share;
}

inline std::vector<double> shares(const shared::Histogram& histogram, uint32_t bins) {
    std::vector<double> h(bins, 0.0);
    for (uint32_t i = 0; i < bins && histogram.votes; ++i) h[i] = histogram.count[i] / double(histogram.votes);
    return h;
}

/// Shares per step of the curve: bins seen through a window, a cubic B-spline whose knots are `window` bins apart, of which the
/// steps take the values in their middles. Whole votes (0): a bin is a step.
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
/// given ceilings c. Exact: bins reach their ceilings in the order of c_i / h_i. lambda goes no higher than `limit`; where that
/// does not fill the range, something is left over.
inline Slopes fill(const std::vector<double>& h, const std::vector<double>& c, double delta, double range, double limit) {
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

/// The tone curve of a steady-state viewer and what it was left with.
struct Adjusted {
    Curve curve;
    double slack = 0;
    bool under = false;
};

/// Thresholds on both sides of the ceiling, cd/m^2.
struct Thresholds {
    std::function<double(double)> scene, display;
};

inline Thresholds thresholds_of(const shared::ToneParameters& p, const ReceptorModel& cones, double cone_sigma, const ReceptorModel& rods, double rod_sigma) {
    const ThresholdBreaks breaks{p.cone_break, p.rod_break};
    const auto linear = [](double l) { return l; };
    const auto human = [=](double l) { return human_threshold(l, breaks); };
    const auto adapted = [=](double l) { return cone_threshold(l, breaks); };
    const auto eye = [=, &cones, &rods](double l) {
        const double t = cones.threshold(l, cone_sigma);
        return p.use_rods ? std::min(t, rods.threshold(p.scotopic * l, rod_sigma) / p.scotopic) : t;
    };
    switch (p.ceiling) {
        case shared::kCeilingLinear: return {linear, linear};
        case shared::kCeilingHuman: return {human, human};
        case shared::kCeilingCones: return {adapted, adapted};
        default: return {eye, adapted};
    }
}

/// Histogram adjustment, Ward et al. 1997: slopes min(lambda h, c), so that dLd / dL <= T_display(Ld) / T_scene(L). In just
/// noticeable differences, dJ = dL / T, that is no more of them on the display than in the scene. The curve is climbed step
/// by step, from the display's darkest luminance, and lambda found by bisection, so that it fills the display; up to a limit. What is then left over
/// first places the curve: `adaptation` is as visible as on a display half as bright as white (Ferwerda et al. 1996), if what
/// there is fits; and then opens what has few votes or none between there and the farthest votes, above and below, up to the ceilings.
inline Adjusted adjust(const std::vector<double>& share, double adaptation, const Thresholds& threshold, const shared::ToneParameters& p) {
    constexpr double kSteepest = 64;  // times plain equalization
    constexpr double kCounts = 1e-4;  // share of the votes that opens a gap as far as may be
    const double delta = 1 / (double(p.bins_per_ln) * p.steps_per_bin), low = p.display_low, high = p.display_high;
    const size_t steps = share.size();
    Adjusted out{{p.ln_low, 1 / delta, std::vector<double>(steps + 1, std::log(low))}, 0, false};
    if (std::accumulate(share.begin(), share.end(), 0.0) == 0) return out;

    const std::vector<double> h = with_spread(share);
    std::vector<double> differences, gap_below, gap_above(steps);
    double sum = 0;
    for (size_t i = 0; i < steps; ++i) {
        const double scene = std::exp(p.ln_low + (double(i) + 0.5) * delta);
        differences.push_back(delta * scene / threshold.scene(scene));
        gap_below.push_back(std::min((sum += share[i]) / kCounts, 1.0));
    }
    sum = 0;
    for (size_t i = steps; i-- > 0;) gap_above[i] = std::min((sum += share[i]) / kCounts, 1.0);

    // A part of step i, negative on the way down; `open` of what the votes leave of the ceiling. That is the midpoint rule for dL
    // and, twice, for d ln L: exact where T is constant, and of fourth order where it is proportional to L.
    const auto advance = [&](double from, size_t i, double part, double lambda, double open) {
        const double seen = part * differences[i], half = std::max(from + seen / 2 * threshold.display(from), low / 2), rise = seen * threshold.display(half);
        const double most = std::max(from + rise / 3 * (1 + 2 * from / std::max(half - rise / 2, from / 4)), low / 2), wanted = from * std::exp(lambda * h[i] * delta * part);
        const double base = part > 0 ? std::min(wanted, most) : std::max(wanted, most);
        return base + open * (most - base);
    };
    // From one position to another one, in steps. Where the luminances at the edges are not kept, gaps that nobody is on the other side of stay closed.
    const auto up = [&](double at, double from, double until, double lambda, double open, std::vector<double>* node = nullptr) {
        for (size_t i = size_t(at); i < steps && double(i) < until; ++i) {
            from = advance(from, i, std::min(until, double(i) + 1) - std::max(at, double(i)), lambda, node ? open : open * gap_above[i]);
            if (node) (*node)[i + 1] = from;
        }
        return from;
    };
    const auto down = [&](double at, double from, double lambda, double open, std::vector<double>* node = nullptr) {
        for (size_t i = size_t(std::ceil(at)); i-- > 0;) {
            from = advance(from, i, double(i) - std::min(at, double(i) + 1), lambda, node ? open : open * gap_below[i]);
            if (node) (*node)[i] = from;
        }
        return from;
    };
    // The last x from a to b from which on is_beyond.
    const auto bisect = [](double a, double b, const auto& is_beyond) {
        if (!is_beyond(b)) return b;
        for (int k = 0; k < 60; ++k) (is_beyond((a + b) / 2) ? b : a) = (a + b) / 2;
        return a;
    };
    const double last = double(steps), plain = std::log(high / low) / delta, limit = kSteepest * plain;
    std::vector<double> node(steps + 1, low);
    const double highest = up(0, low, last, limit, 0);
    out.under = highest <= high;
    if (!out.under) {
        const double lambda = std::exp(bisect(std::log(plain), std::log(limit), [&](double x) { return up(0, low, last, std::exp(x), 0) > high; }));
        up(0, low, last, lambda, 0, &node);
    } else {
        out.slack = std::log(high / highest);
        const double at = std::clamp((std::log(adaptation) - p.ln_low) / delta, 0.0, last);
        const double want = adaptation * threshold.display(high / 2) / threshold.scene(adaptation);
        const double start = std::exp(bisect(std::log(low), std::log(high), [&](double x) {
            const double there = up(0, std::exp(x), at, limit, 0);
            return there > want || up(at, there, last, limit, 0) > high;
        }));
        const double there = up(0, start, at, limit, 0);
        const double above = bisect(0, 1, [&](double open) { return up(at, there, last, limit, open) > high; });
        const double below = bisect(0, 1, [&](double open) { return down(at, there, limit, open) < low; });
        up(at, there, last, limit, above, &node);
        down(at, there, limit, below, &node);
        if (at == std::floor(at)) node[size_t(at)] = there;
    }
    for (size_t i = 0; i <= steps; ++i) out.curve.node[i] = std::log(std::clamp(node[i], low, high));
    return out;
}

/// Ward's own way, as pcond of Radiance has it (tone-mapping.md, section 3): clip counts to their ceilings, again with the new
/// total, until what is clipped is within 2.5 % of it; the curve is that before the last clip. Linear where the range of the scene
/// is no more than the display's, or hardly any counts are left; `average` is then shown at the geometric middle.
inline Adjusted trim(const std::vector<double>& share, double average, const Thresholds& threshold, const shared::ToneParameters& p) {
    constexpr double kTolerance = 0.025;
    const double low = std::log(double(p.display_low)), high = std::log(double(p.display_high)), range = high - low, delta = 1 / (double(p.bins_per_ln) * p.steps_per_bin);
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
            const double scene = std::exp(p.ln_low + (double(i) + 0.5) * delta), shown = std::exp((out.curve.node[i] + out.curve.node[i + 1]) / 2);
            const double most = total * delta / range * (threshold.display(shown) / shown) / (threshold.scene(scene) / scene);
            if (f[i] > most) trimmed += f[i] - most, f[i] = most;
        }
        if (trimmed <= kTolerance * total) return out;
    }
    const double middle = std::exp((low + high) / 2), scale = threshold.display(middle) / threshold.scene(average);
    for (size_t i = 0; i <= f.size(); ++i) out.curve.node[i] = std::clamp(p.ln_low + double(i) * delta + std::log(scale), low, high);
    return out;
}

}  // namespace vesper::reference
