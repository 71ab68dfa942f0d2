// What the eye adapts to, its state and the tone curve, smoothed over time. SPDX-License-Identifier: MIT
// Histogram adjustment: Ward Larson, Rushmeier and Piatko 1997, solved exactly for given ceilings; thresholds of
// Ferwerda, Pattanaik, Shirley and Greenberg 1996; the eye of vision/eye.h; Reinhard, Stark, Shirley and Ferwerda 2002.
#pragma once

#include <functional>
#include <numeric>
#include <vector>

#include "passes/anchor_reference.h"
#include "passes/pyramid_reference.h"
#include "vision/eye.h"
#include "vision/pattanaik.h"
#include "shared/tone.h"

namespace vesper::reference {

/// Mean or log average of the finite pixels of 3 x 3 texels about the gaze, linear in its position: the mean over squares about
/// the four texels nearest to it, each weighted as in bilinear interpolation. Negative if there are none.
inline double gaze_luminance(const PyramidLevel& fovea, const shared::ToneParameters& p) {
    const auto texel = [&](double x, double y) {
        const bool inside = x >= 0 && y >= 0 && x < fovea.width && y < fovea.height;
        return inside ? fovea.at(uint32_t(x), uint32_t(y)) : dvec4(0);
    };
    if (p.adapt_to == shared::kAdaptTexel) {
        const dvec4 t = texel(std::clamp(std::floor(double(p.gaze.x)), 0.0, fovea.width - 1.0), std::clamp(std::floor(double(p.gaze.y)), 0.0, fovea.height - 1.0));
        return t.y > 0 ? t.x : -1;
    }
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
    if (pixels == 0) return -1;
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
    const glm::dmat3 xyz = glm::transpose(glm::dmat3(0.412391, 0.357584, 0.180481, 0.212639, 0.715169, 0.072192, 0.019331, 0.119195, 0.950532));
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
    pattanaik::State pattanaik;
    shared::ToneCurve tone{};
    shared::EyeState eye{};
};

inline Adapted adapt(const AdaptInputs& in) {
    const shared::ToneParameters& p = in.parameters;
    Adapted out;
    const bool empty = in.histogram.finite == 0, first = !(in.previous.adaptation > 0);
    const double log_average = empty ? kFloor : std::exp(in.top.z), maximum = empty ? 0.0 : in.top.w;
    const double looked_at = p.adapt_to == shared::kAdaptAverage ? log_average : gaze_luminance(in.fovea, p);
    const double adaptation = std::clamp(!empty && looked_at >= 0 ? looked_at : first ? log_average : double(in.previous.adaptation), kFloor, 1e6);

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
        out.adjusted = adjust(per_step(out.share, p), adapted_luminance(cone_sigma, cones), thresholds_of(p, cones, cone_sigma, rods, rod_sigma), p);
    else if (in.model == shared::kModelTrimmed)
        out.adjusted = trim(out.share, adaptation, thresholds_of(p, cones, cone_sigma, rods, rod_sigma), p);
    else
        out.adjusted = {{p.ln_low, double(p.bins_per_ln) * p.steps_per_bin, std::vector<double>(size_t(p.bins) * p.steps_per_bin + 1, std::log(double(p.display_low)))}, 0, false};

    // Over time every node of the curve follows, in ln Ld, never more than a tenth away; what is empty, and a pause, leave it as it was.
    constexpr double kLeash = 0.25;
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
    const shared::PattanaikState& pattanaik = in.previous.pattanaik;
    out.pattanaik = {pattanaik.cones, pattanaik.rods, pattanaik.cone_pigment, pattanaik.rod_pigment};
    if (in.model == shared::kModelPattanaik) {
        out.pattanaik = first || !(pattanaik.cones > 0) ? pattanaik::adapted(adaptation, scotopic) : pattanaik::after(out.pattanaik, adaptation, scotopic, p.seconds);
        const pattanaik::Appearance appearance(out.pattanaik, p.rod_constant);
        t.ln_low = float(std::log(1e-4)), t.bins = float(shared::kMaxNodes), t.bins_per_ln = float(shared::kMaxNodes / std::log(1e12));
        t.response_offset = float(appearance.offset());
        t.response_unit = float(pattanaik::cone_sigma(25) / 125);
        for (uint32_t i = 0; i <= shared::kMaxNodes; ++i) t.node[i] = glm::vec4(glm::vec3(lagging_node(appearance, i, p)), 0);
    }

    const auto memory = [](const ReceptorState& s) { return shared::ReceptorMemory{float(s.pigment), float(s.fast), float(s.slow)}; };
    out.eye.adaptation = float(adaptation);
    const double time = double(in.previous.seconds) + double(in.previous.seconds_lost) + double(p.seconds);
    out.eye.seconds = std::min(float(time), shared::kLongestLife), out.eye.seconds_lost = float(time - double(out.eye.seconds));
    const double pupil = in.previous.pupil > 0 ? in.previous.pupil : 4.9, rest = pupil_moon_spencer(adaptation);
    out.eye.pupil = float(rest + (pupil - rest) * std::exp(-double(p.seconds) / 0.5));
    out.eye.cones = memory(out.cones), out.eye.rods = memory(out.rods);
    out.eye.pattanaik = {float(out.pattanaik.cones), float(out.pattanaik.rods), float(out.pattanaik.cone_pigment), float(out.pattanaik.rod_pigment)};
    if (has_curve) out.eye.steps = float(steps), out.eye.ln_low = p.ln_low, out.eye.steps_per_ln = float(curve.bins_per_ln);
    for (size_t i = 0; i <= steps && has_curve; ++i) out.eye.node[i] = float(out.adjusted.curve.node[i]);
    return out;
}

}  // namespace vesper::reference
