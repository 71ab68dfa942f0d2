// What the eye adapts to, its state and the tone curve, smoothed over time. SPDX-License-Identifier: MIT
// Histogram adjustment: Ward Larson, Rushmeier and Piatko 1997, solved exactly for given ceilings; thresholds of
// Ferwerda, Pattanaik, Shirley and Greenberg 1996; the eye of vision/eye.h; operators/ holds what operators make of it.
#pragma once

#include "passes/operators/gains_reference.h"
#include "passes/operators/linear_reference.h"
#include "passes/operators/pattanaik_reference.h"
#include "passes/operators/reinhard_reference.h"

namespace vesper::reference {

/// Mean or log average of the finite pixels of 3 x 3 texels about the gaze, linear in its position: the mean over
/// squares about the four texels nearest to it, each weighted as in bilinear interpolation. Negative if there are none.
inline double gaze_luminance(const PyramidLevel& fovea, const shared::ToneParameters& p) {
    const auto texel = [&](double x, double y) {
        const bool inside = x >= 0 && y >= 0 && x < fovea.width && y < fovea.height;
        return inside ? fovea.at(uint32_t(x), uint32_t(y)) : dvec4(0);
    };
    if (p.adapt_to == shared::kAdaptTexel) {
        const dvec4 t = texel(std::clamp(std::floor(double(p.gaze.x)), 0.0, fovea.width - 1.0),
                              std::clamp(std::floor(double(p.gaze.y)), 0.0, fovea.height - 1.0));
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

inline Adapted adapt(const AdaptInputs& in) {
    const shared::ToneParameters& p = in.parameters;
    Adapted out;
    const bool empty = in.histogram.finite == 0, first = !(in.previous.adaptation > 0);
    const double log_average = empty ? kFloor : std::exp(in.top.z), maximum = empty ? 0.0 : in.top.w;
    const double looked_at = p.adapt_to == shared::kAdaptAverage ? log_average : gaze_luminance(in.fovea, p);
    const double adaptation = std::clamp(!empty && looked_at >= 0 ? looked_at
                                         : first                  ? log_average
                                                                  : double(in.previous.adaptation),
                                         kFloor, 1e6);

    const vision::ThresholdBreaks breaks{p.cone_break, p.rod_break};
    const vision::ReceptorModel cones(vision::ReceptorKind::Cones, in.observer.observed_cones(), breaks),
        rods(vision::ReceptorKind::Rods, in.observer.observed_rods(), breaks);
    const auto step = [&](const vision::ReceptorModel& model, const shared::ReceptorMemory& m, double light) {
        return first ? model.adapted(light) : model.after({m.pigment, m.fast, m.slow}, light, p.seconds);
    };
    const double scotopic = p.scotopic * adaptation;
    out.cones = step(cones, in.previous.cones, adaptation), out.rods = step(rods, in.previous.rods, scotopic);
    const double cone_sigma = cones.sigma(out.cones), rod_sigma = rods.sigma(out.rods);

    out.share = shares(in.histogram, p.bins);
    const bool has_curve = render::operator_info(in.tone_operator).histogram;
    if (in.tone_operator == render::Operator::Ward)
        out.adjusted = trim(out.share, adaptation, thresholds_of(p, cones, cone_sigma, rods, rod_sigma), p);
    else if (has_curve)
        out.adjusted = adjust(per_step(out.share, p), adapted_luminance(cone_sigma, cones),
                              thresholds_of(p, cones, cone_sigma, rods, rod_sigma), p);
    else
        out.adjusted = {{p.ln_low, double(p.bins_per_ln) * p.steps_per_bin,
                         std::vector<double>(size_t(p.bins) * p.steps_per_bin + 1, std::log(double(p.display_low)))},
                        0,
                        false};

    // Over time every node of the curve follows, in ln Ld, never more than kLeash away; what is empty, and a pause,
    // leave it as it was.
    constexpr double kLeash = 0.25;
    const Curve& curve = out.adjusted.curve;
    const size_t steps = curve.node.size() - 1;
    const bool same_steps = in.previous.steps == float(steps) && in.previous.ln_low == p.ln_low &&
                            in.previous.steps_per_ln == float(curve.bins_per_ln);
    const double kept = empty ? 1 : p.smoothing_seconds > 0 ? std::exp(-double(p.seconds) / p.smoothing_seconds) : 0;
    for (size_t i = 0; i <= steps && has_curve && !first && same_steps; ++i) {
        double& node = out.adjusted.curve.node[i];
        const double lag = (in.previous.node[i] - node) * kept;
        node += kept < 1 ? std::clamp(lag, -kLeash, kLeash) : lag;
    }

    shared::ToneCurve& t = out.tone;
    t.adaptation = float(adaptation), t.log_average = float(log_average), t.maximum = float(maximum);
    t.cone_sigma = float(cone_sigma), t.rod_sigma = float(rod_sigma);
    t.ln_low = p.ln_low, t.bins_per_ln = p.bins_per_ln * float(p.steps_per_bin),
    t.bins = float(p.bins * p.steps_per_bin);
    t.under_full = out.adjusted.under ? 1.0f : 0.0f;
    t.slack = float(out.adjusted.slack);
    for (size_t i = 0; i < out.adjusted.curve.node.size(); ++i) t.node[i].x = float(out.adjusted.curve.node[i]);
    const shared::PattanaikState& pattanaik = in.previous.pattanaik;
    out.pattanaik = {pattanaik.cones, pattanaik.rods, pattanaik.cone_pigment, pattanaik.rod_pigment};
    out.eye.chroma = in.previous.chroma;
    const OperatorFrame frame{in,         empty,      first,    log_average, empty ? 0.0 : in.top.x,
                              maximum,    adaptation, scotopic, cones,       rods,
                              cone_sigma, rod_sigma,  breaks};
    if (const auto found = operator_references().find(in.tone_operator); found != operator_references().end()) {
        found->second.frame(frame, out);
    } else {
        switch (in.tone_operator) {
            case render::Operator::Reinhard:
                reinhard_frame(frame, out);
                break;
            case render::Operator::Linear:
                linear_frame(frame, out);
                break;
            case render::Operator::Pattanaik:
                pattanaik_frame(frame, out);
                break;
            case render::Operator::Ferwerda:
            case render::Operator::Durand:
                gains_frame(frame, out);
                break;
            // What comes out of bands is luminance of the display.
            case render::Operator::Grave:
                t.block[0] = {p.display_low, 1 / (p.display_high - p.display_low), 0, 0};
                break;
            default:
                break;
        }
    }

    const auto memory = [](const vision::ReceptorState& s) {
        return shared::ReceptorMemory{float(s.pigment), float(s.fast), float(s.slow)};
    };
    out.eye.adaptation = float(adaptation);
    const double time = double(in.previous.seconds) + double(in.previous.seconds_lost) + double(p.seconds);
    out.eye.seconds = std::min(float(time), 1e12f), out.eye.seconds_lost = float(time - double(out.eye.seconds));
    const double pupil = in.previous.pupil > 0 ? in.previous.pupil : 4.9, rest = vision::pupil_moon_spencer(adaptation);
    out.eye.pupil = float(rest + (pupil - rest) * std::exp(-double(p.seconds) / 0.5));
    out.eye.cones = memory(out.cones), out.eye.rods = memory(out.rods);
    out.eye.pattanaik = {float(out.pattanaik.cones), float(out.pattanaik.rods), float(out.pattanaik.cone_pigment),
                         float(out.pattanaik.rod_pigment)};
    if (has_curve)
        out.eye.steps = float(steps), out.eye.ln_low = p.ln_low, out.eye.steps_per_ln = float(curve.bins_per_ln);
    for (size_t i = 0; i <= steps && has_curve; ++i) out.eye.node[i] = float(out.adjusted.curve.node[i]);
    return out;
}

}  // namespace vesper::reference
