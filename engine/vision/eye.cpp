#include "vision/eye.h"

#include <algorithm>
#include <cmath>

namespace vesper::vision {

Receptors Receptors::cones() {
    return {.weber = -1.255,
            .fast_seconds = 0.08,
            .slow_seconds = 10,
            .fast_share = 0.5,
            .bleach_seconds = 120,
            .bleach_trolands = std::pow(10.0, 4.3)};
}

Receptors Receptors::rods() {
    return {.weber = -0.395,
            .fast_seconds = 0.15,
            .slow_seconds = 60,
            .fast_share = 0.3,
            .bleach_seconds = 400,
            .bleach_trolands = 1e7};
}

ReceptorModel::ReceptorModel(ReceptorKind kind, const Receptors& receptors, ThresholdBreaks breaks)
    : kind_(kind), receptors_(receptors), breaks_(breaks) {
    const double c = receptors.semi_saturation;
    step_ = receptors.threshold_factor * std::pow(10.0, receptors.weber) * c / ((1 + c) * (1 + c));
    constexpr double kDark = 1e-9;  // far down where both curves are flat
    dark_ = adapted_threshold(kDark) / step_;
}

double ReceptorModel::adapted_threshold(double luminance) const {
    return receptors_.threshold_factor *
           (kind_ == ReceptorKind::Cones ? cone_threshold(luminance, breaks_) : rod_threshold(luminance, breaks_));
}

// T = Delta R (L + sigma)^2 / sigma, solved for the sigma that is at least L.
double ReceptorModel::adapted_sigma(double luminance) const {
    const double q = adapted_threshold(luminance) / (luminance * step_);
    return luminance * (q - 2 + std::sqrt(std::max(q * q - 4 * q, 0.0))) / 2;
}

double ReceptorModel::adapted_pigment(double luminance) const {
    return receptors_.bleach_trolands / (receptors_.bleach_trolands + trolands(luminance));
}

double ReceptorModel::neural(double luminance) const {
    return std::log10(adapted_sigma(luminance) * adapted_pigment(luminance) / dark_);
}

ReceptorState ReceptorModel::adapted(double luminance) const {
    const double e = neural(luminance), f = receptors_.fast_share;
    return {adapted_pigment(luminance), f * e, (1 - f) * e};
}

ReceptorState ReceptorModel::after(const ReceptorState& state, double luminance, double seconds) const {
    const ReceptorState goal = adapted(luminance);
    const double rate = (1 + trolands(luminance) / receptors_.bleach_trolands) / receptors_.bleach_seconds;
    const auto towards = [](double from, double to, double time_constants) {
        return to + (from - to) * std::exp(-time_constants);
    };
    return {towards(state.pigment, goal.pigment, rate * seconds),
            towards(state.fast, goal.fast, seconds / receptors_.fast_seconds),
            towards(state.slow, goal.slow, seconds / receptors_.slow_seconds)};
}

double ReceptorModel::sigma(const ReceptorState& state) const {
    return dark_ * std::pow(10.0, state.fast + state.slow) / state.pigment;
}

double ReceptorModel::threshold(double luminance, double sigma) const {
    return step_ * (luminance + sigma) * (luminance + sigma) / sigma;
}

std::optional<double> ReceptorModel::increment(double luminance, double sigma) const {
    const double response = luminance / (luminance + sigma) + step_;
    if (response >= 1) return std::nullopt;
    return sigma * response / (1 - response) - luminance;
}

std::optional<double> ReceptorModel::decrement(double luminance, double sigma) const {
    const double response = luminance / (luminance + sigma) - step_;
    if (response <= 0) return std::nullopt;
    return luminance - sigma * response / (1 - response);
}

Receptors Observer::observed_cones() const {
    Receptors r = cones;
    r.threshold_factor *= low_vision * age_factor(age);
    return r;
}

Receptors Observer::observed_rods() const {
    Receptors r = rods;
    r.threshold_factor *= low_vision * age_factor(age);
    return r;
}

}  // namespace vesper::vision
