// What the eye adapts to, its state and the tone curve, smoothed over time. SPDX-License-Identifier: MIT
// Histogram adjustment: Ward Larson, Rushmeier and Piatko 1997, solved exactly for given ceilings; thresholds of
// Ferwerda, Pattanaik, Shirley and Greenberg 1996; the eye of perception/eye.h; Reinhard, Stark, Shirley and Ferwerda 2002.
#pragma once

#include <functional>
#include <numeric>
#include <vector>

#include "passes/pyramid_reference.h"
#include "perception/eye.h"
#include "perception/pattanaik.h"
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

/// Mean or log average of the finite pixels of 3 x 3 texels about the gaze, linear in its position: the mean over squares about
/// the four texels nearest to it, each weighted as in bilinear interpolation. 0 if there are none.
inline double gaze_luminance(const PyramidLevel& fovea, const shared::ToneParameters& p) {
    const auto texel = [&](double x, double y) {
        const bool inside = x >= 0 && y >= 0 && x < fovea.width && y < fovea.height;
        return inside ? fovea.at(uint32_t(x), uint32_t(y)) : dvec4(0);
    };
    if (p.adapt_to == shared::kAdaptTexel)
        return texel(std::clamp(std::floor(double(p.gaze.x)), 0.0, fovea.width - 1.0), std::clamp(std::floor(double(p.gaze.y)), 0.0, fovea.height - 1.0)).x;
    const dvec2 at = dvec2(p.gaze) - 0.5, base = glm::floor(at), part = at - base;
    double sum = 0, pixels = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const dvec2 middle = base + dvec2(corner & 1, corner >> 1);
        const double weight = (corner & 1 ? part.x : 1 - part.x) * (corner >> 1 ? part.y : 1 - part.y);
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const dvec4 t = texel(middle.x + x, middle.y + y);
                sum += weight * t.y * (p.adapt_to == shared::kAdaptGaze ? t.z : t.x), pixels += weight * t.y;
            }
    }
    if (pixels == 0) return 0;
    return p.adapt_to == shared::kAdaptGaze ? std::exp(sum / pixels) : sum / pixels;
}

/// ln of the luminance below which a part of the votes is, linear within a bin.
inline double percentile(const std::vector<double>& share, double part, const shared::ToneParameters& p) {
    const double all = std::accumulate(share.begin(), share.end(), 0.0);
    double below = 0;
    for (size_t i = 0; i < share.size(); below += share[i++])
        if (below / all < part && (below + share[i]) / all >= part) return p.ln_low + (double(i) + (part * all - below) / share[i]) / p.bins_per_ln;
    return p.ln_low;
}

/// Node i of Pattanaik's table: from 1e-4 to 1e8 cd/m^2.
inline dvec3 lagging_node(const pattanaik::Appearance& appearance, uint32_t i, const shared::ToneParameters& p) {
    const double luminance = std::pow(10, -4 + 12.0 * i / shared::kMaxNodes);
    return {appearance.cones(luminance), appearance(luminance, luminance).colour_exponent, appearance.rods(p.scotopic * luminance)};
}

/// Responses of cones to linear Rec. 709: XYZ (IEC 61966-2-1) through Estevez 1979.
inline dvec3 cone_responses(dvec3 rgb) {
    const glm::dmat3 xyz = glm::transpose(glm::dmat3(0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505));
    const glm::dmat3 estevez = glm::transpose(glm::dmat3(0.38971, 0.68898, -0.07868, -0.22981, 1.18340, 0.04641, 0, 0, 1));
    return estevez * (xyz * rgb);
}
inline glm::dmat3 cone_matrix() { return {cone_responses({1, 0, 0}), cone_responses({0, 1, 0}), cone_responses({0, 0, 1})}; }

/// ln of cones' responses, averaged over tiles, over those to white of the luminance they stand for.
inline dvec3 looked_at_chroma(const PyramidLevel& tiles, dvec3 before) {
    dvec3 sum(0);
    double pixels = 0;
    for (const dvec4& t : tiles.texels) sum += t.w * glm::log(glm::max(cone_responses(glm::max(dvec3(t), dvec3(0))), dvec3(kFloor))), pixels += t.w;
    if (pixels == 0) return before;
    const dvec3 cones = glm::exp(sum / pixels);
    return glm::log(cones / (std::max(luminance(glm::inverse(cone_matrix()) * cones), kFloor) * cone_responses(dvec3(1))));
}

/// Von Kries's adaptation as far as CIECAM02 has it at a luminance (Moroney et al. 2002), for Rec. 709.
inline glm::dmat3 chromatic_adaptation(dvec3 chroma, double luminance) {
    const double degree = 1 - std::exp((-luminance - 42) / 92) / 3.6;
    const dvec3 gain = degree * glm::exp(-chroma) + dvec3(1 - degree);
    glm::dmat3 diagonal(0);
    for (int i = 0; i < 3; ++i) diagonal[i][i] = gain[i];
    return glm::inverse(cone_matrix()) * diagonal * cone_matrix();
}

/// Everything the pass reads.
struct AdaptInputs {
    shared::Histogram histogram{};
    dvec4 top{0};         ///< the 1x1 level of the pyramid
    PyramidLevel fovea;
    shared::EyeState previous{};
    shared::ToneParameters parameters{};
    Observer observer;
    uint32_t model = shared::kModelHistogram;
    PyramidLevel colours;        ///< tiles; empty: the eye does not adapt to colour
};

/// Everything the pass writes, in double where it matters.
struct Adapted {
    Adjusted adjusted;
    ReceptorState cones, rods;
    std::vector<double> share;
    pattanaik::State lagging;
    shared::ToneCurve tone{};
    shared::EyeState eye{};
};

inline Adapted adapt(const AdaptInputs& in) {
    const shared::ToneParameters& p = in.parameters;
    Adapted out;
    const bool empty = in.histogram.finite == 0, first = !(in.previous.adaptation > 0);
    const double log_average = empty ? kFloor : std::exp(in.top.z), maximum = empty ? 0.0 : in.top.w;
    const double looked_at = p.adapt_to == shared::kAdaptAverage ? log_average : gaze_luminance(in.fovea, p);
    const double adaptation = std::clamp(empty && !first ? double(in.previous.adaptation) : looked_at, kFloor, 1e6);

    const ThresholdBreaks breaks{p.cone_break, p.rod_break};
    const ReceptorModel cones(ReceptorKind::Cones, in.observer.observed_cones(), breaks), rods(ReceptorKind::Rods, in.observer.observed_rods(), breaks);
    const auto step = [&](const ReceptorModel& model, const shared::ReceptorMemory& m, double light) {
        return first ? model.adapted(light) : model.after({m.pigment, m.fast, m.slow}, light, p.seconds);
    };
    const double scotopic = p.scotopic * adaptation;
    out.cones = step(cones, in.previous.cones, adaptation), out.rods = step(rods, in.previous.rods, scotopic);
    const double cone_sigma = cones.sigma(out.cones), rod_sigma = rods.sigma(out.rods);

    out.share = shares(in.histogram, p.bins);
    if (in.model == shared::kModelHistogram)
        out.adjusted = adjust(per_step(out.share, p), adaptation, thresholds_of(p, cones, cone_sigma, rods, rod_sigma), p);
    else if (in.model == shared::kModelTrimmed)
        out.adjusted = trim(out.share, adaptation, thresholds_of(p, cones, cone_sigma, rods, rod_sigma), p);
    else
        out.adjusted = {{p.ln_low, double(p.bins_per_ln) * p.steps_per_bin, std::vector<double>(size_t(p.bins) * p.steps_per_bin + 1, std::log(double(p.display_low)))}, 0, false};

    // Over time every node of the curve follows, in ln Ld, never more than a tenth away; what is empty, and a pause, leave it as it was.
    constexpr double kLeash = 0.1;
    const bool has_curve = in.model == shared::kModelHistogram || in.model == shared::kModelTrimmed;
    const Curve& curve = out.adjusted.curve;
    const size_t steps = curve.node.size() - 1;
    const bool same_steps = in.previous.steps == float(steps) && in.previous.ln_low == p.ln_low && in.previous.steps_per_ln == float(curve.bins_per_ln);
    const double kept = empty ? 1 : p.smoothing_seconds > 0 ? std::exp(-double(p.seconds) / p.smoothing_seconds) : 0;
    for (size_t i = 0; i <= steps && has_curve && !first && same_steps; ++i) {
        double& node = out.adjusted.curve.node[i];
        const double lag = (in.previous.node[i] - node) * kept;
        node += kept < 1 ? std::clamp(lag, -kLeash, kLeash) : lag;
    }

    shared::ToneCurve& t = out.tone;
    t.adaptation = float(adaptation), t.log_average = float(log_average), t.maximum = float(maximum);
    t.cone_sigma = float(cone_sigma), t.rod_sigma = float(rod_sigma);
    double key = p.key, white = key / log_average * (p.white > 0 ? double(p.white) : std::max(maximum, kFloor));
    if (in.model == shared::kModelFixed && p.automatic) {  // Reinhard 2003, Eq. 4 and 5
        const double low = percentile(out.share, 0.01, p) / std::log(2), high = percentile(out.share, 0.99, p) / std::log(2), average = std::log2(log_average);
        key = 0.18 * std::pow(4, (2 * average - low - high) / std::max(high - low, 1e-3));
        white = 1.5 * std::exp2(std::max(high - low, 1e-3) - 5);
    }
    t.reinhard_scale = float(key / log_average);
    t.reinhard_white = float(1 / (white * white));
    const double high = p.linear_high != 0 ? double(p.linear_high) : maximum;
    t.linear_low = p.linear_low;
    t.linear_gain = float(1 / std::max(high - p.linear_low, kFloor));
    if (in.model == shared::kModelGains) {  // Ferwerda et al. 1996, Eq. 7 to 11: thresholds become those of the display
        const bool in_state = p.ceiling == shared::kCeilingEye;
        const double shown = cone_threshold(p.display_high / 2.0, breaks);
        const double cone_gain = shown / (in_state ? cones.threshold(adaptation, cone_sigma) : cones.adapted_threshold(adaptation));
        const double rod_gain = shown / (in_state ? rods.threshold(scotopic, rod_sigma) : rods.adapted_threshold(scotopic));
        const double k = std::pow(std::clamp(1 - (adaptation / 2 - 0.01) / 9.99, 0.0, 1.0), 2);
        t.linear_low = float(p.display_low / cone_gain);
        t.linear_gain = float(cone_gain / (double(p.display_high) - double(p.display_low)));
        t.rods = glm::vec3(glm::dvec3(p.rod_tint) * (k * rod_gain * p.scotopic / cone_gain));
    }
    dvec3 chroma(in.previous.chroma);
    glm::dmat3 seen(1);
    if (in.model == shared::kModelGains && !in.colours.texels.empty()) {
        const dvec3 goal = looked_at_chroma(in.colours, chroma);  // half at once, half with a half-life of 20 s (Rinner and Gegenfurtner 2000)
        chroma = first ? goal : goal + (chroma - goal) * std::exp2(-double(p.seconds) / 20);
        seen = chromatic_adaptation((goal + chroma) / 2.0, adaptation);
    }
    const glm::dmat3 rows = glm::transpose(seen);
    t.red = glm::vec4(glm::vec3(rows[0]), 0), t.green = glm::vec4(glm::vec3(rows[1]), 0), t.blue = glm::vec4(glm::vec3(rows[2]), 0);
    out.eye.chroma = glm::vec3(chroma);
    t.ln_low = p.ln_low, t.bins_per_ln = p.bins_per_ln * float(p.steps_per_bin), t.bins = float(p.bins * p.steps_per_bin);
    t.under_full = out.adjusted.under ? 1.0f : 0.0f;
    t.slack = float(out.adjusted.slack);
    for (size_t i = 0; i < out.adjusted.curve.node.size(); ++i) t.node[i].x = float(out.adjusted.curve.node[i]);
    const shared::LaggingEye& lagging = in.previous.lagging;
    out.lagging = {lagging.cones, lagging.rods, lagging.cone_pigment, lagging.rod_pigment};
    if (in.model == shared::kModelLagging) {
        out.lagging = first || !(lagging.cones > 0) ? pattanaik::adapted(adaptation, scotopic) : pattanaik::after(out.lagging, adaptation, scotopic, p.seconds);
        const pattanaik::Appearance appearance(out.lagging, p.rod_constant);
        t.ln_low = float(std::log(1e-4)), t.bins = float(shared::kMaxNodes), t.bins_per_ln = float(shared::kMaxNodes / std::log(1e12));
        t.response_offset = float(appearance.offset());
        t.response_unit = float(pattanaik::cone_sigma(25) / 125);
        for (uint32_t i = 0; i <= shared::kMaxNodes; ++i) t.node[i] = glm::vec4(glm::vec3(lagging_node(appearance, i, p)), 0);
    }

    const auto memory = [](const ReceptorState& s) { return shared::ReceptorMemory{float(s.pigment), float(s.fast), float(s.slow)}; };
    out.eye.adaptation = float(adaptation), out.eye.seconds = in.previous.seconds + p.seconds;
    out.eye.cones = memory(out.cones), out.eye.rods = memory(out.rods);
    out.eye.lagging = {float(out.lagging.cones), float(out.lagging.rods), float(out.lagging.cone_pigment), float(out.lagging.rod_pigment)};
    if (has_curve) out.eye.steps = float(steps), out.eye.ln_low = p.ln_low, out.eye.steps_per_ln = float(curve.bins_per_ln);
    for (size_t i = 0; i <= steps && has_curve; ++i) out.eye.node[i] = float(out.adjusted.curve.node[i]);
    return out;
}

}  // namespace vesper::reference
