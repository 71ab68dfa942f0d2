// Histograms of made-up scenes, and what tone curves are made of. SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include "passes/anchor_reference.h"
#include "render/passes/adapt.h"

namespace vesper::reference {

constexpr uint32_t kBins = 100;

inline const vision::ReceptorModel kCones(vision::ReceptorKind::Cones, vision::Receptors::cones()),
    kRods(vision::ReceptorKind::Rods, vision::Receptors::rods());

inline shared::ToneParameters parameters_of(double low = 0.5, double high = 200,
                                            uint32_t ceiling = shared::kCeilingCones) {
    shared::ToneParameters p{};
    p.ceiling = ceiling;
    p.cone_break = 1.9f, p.rod_break = -1.44f;
    p.adapt_to = shared::kAdaptAverage;
    p.bins = kBins, p.steps_per_bin = 1;
    p.ln_low = float(std::log(1e-4)), p.bins_per_ln = float(10 / std::log(10.0));  // tenths of a decade
    p.display_low = float(low), p.display_high = float(high);
    p.viewer_sigma = float(kCones.adapted_sigma(0.3 * high)), p.viewer_step = float(kCones.response_step());
    p.scotopic = 1;
    return p;
}

/// The curve for an eye adapted to `adaptation`.
inline Adjusted curve_of(const shared::Histogram& histogram, double adaptation, const shared::ToneParameters& p) {
    const Thresholds t =
        thresholds_of(p, kCones, kCones.adapted_sigma(adaptation), kRods, kRods.adapted_sigma(adaptation));
    return adjust(shares(histogram, kBins), adaptation, t, p);
}

/// Votes spread like a night street: a broad dark hill, a few bright lamps.
inline shared::Histogram night(uint32_t seed = 1) {
    shared::Histogram histogram{};
    std::mt19937 random(seed);
    std::normal_distribution<double> road(30, 8), lamps(85, 3);
    for (int i = 0; i < 20000; ++i) {
        const double at = i % 100 == 0 ? lamps(random) : road(random);
        ++histogram.count[uint32_t(std::clamp(at, 0.0, kBins - 1.0))];
        ++histogram.finite, ++histogram.votes;
    }
    return histogram;
}

/// All votes in a few neighbouring bins: fog, or an evenly lit day.
inline shared::Histogram fog(uint32_t from, uint32_t to) {
    shared::Histogram histogram{};
    for (uint32_t i = from; i <= to; ++i) histogram.count[i] = 100, histogram.finite += 100, histogram.votes += 100;
    return histogram;
}

/// Votes of luminances (ln) and their shares, each shared by two bins.
inline std::vector<double> split_votes(const std::vector<std::pair<double, double>>& votes,
                                       const shared::ToneParameters& p) {
    std::vector<double> share(p.bins, 0.0);
    for (const auto& [ln, part] : votes) {
        const double middle = std::clamp((ln - p.ln_low) * double(p.bins_per_ln) - 0.5, 0.0, p.bins - 1.0);
        const size_t bin = std::min(size_t(middle), size_t(p.bins - 2));
        share[bin] += part * (1 - (middle - double(bin))), share[bin + 1] += part * (middle - double(bin));
    }
    return share;
}

/// The default settings' parameters at a number of bins; a display from 0.12 to 100 cd/m^2.
inline shared::ToneParameters split_parameters(uint32_t bins, uint32_t ceiling = shared::kCeilingEye) {
    shared::ToneParameters p = parameters_of(0.12, 100, ceiling);
    const render::HistogramSettings settings{.bins = bins};
    p.bins = bins, p.bins_per_ln = settings.bins_per_ln(), p.steps_per_bin = settings.steps_per_bin(),
    p.window = settings.window();
    p.cone_break = float(vision::ThresholdBreaks::continuous().cones),
    p.rod_break = float(vision::ThresholdBreaks::continuous().rods);
    return p;
}

inline Adjusted curve_of_votes(const std::vector<std::pair<double, double>>& votes, double adaptation,
                               const shared::ToneParameters& p) {
    const Thresholds t =
        thresholds_of(p, kCones, kCones.adapted_sigma(adaptation), kRods, kRods.adapted_sigma(adaptation));
    return adjust(per_step(split_votes(votes, p), p), adaptation, t, p);
}

}  // namespace vesper::reference
