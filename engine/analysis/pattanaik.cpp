#include "analysis/pattanaik.h"

#include <algorithm>
#include <cmath>

namespace vesper::analysis::pattanaik {
namespace {

constexpr double kWhite = 5, kBlack = 5.0 / 32;  // reference luminances over the adaptation luminance
constexpr double kDisplayAdaptation = 25;        // cd/m^2

double excitation(double luminance, double sigma) { return std::pow(luminance / sigma, kExponent); }
double response(double luminance, double sigma) {
    const double x = excitation(luminance, sigma);
    return x / (1 + x);
}

// A pigment with time constant tau that `half` cd/m^2 bleach to a half.
double pigment_after(double pigment, double goal, double tau, double half, double seconds) {
    const double steady = half / (half + goal);
    return steady + (pigment - steady) * std::exp(-(1 + goal / half) / tau * seconds);
}

}  // namespace

double cone_sigma(double a) {
    const double k4 = std::pow(5 * a + 1, -4);
    return 12.9223 * a / (k4 * a + 0.171 * (1 - k4) * (1 - k4) * std::cbrt(a));
}

double rod_sigma(double a, double rod_constant) {
    const double j2 = std::pow(rod_constant * a + 1, -2);
    return 2.5874 * a / (19000 * j2 * a + 0.2615 * std::pow(1 - j2, 4) * std::pow(a, 1.0 / 6));
}

State adapted(double goal, double scotopic) { return {goal, scotopic, 2e6 / (2e6 + goal), 0.04 / (0.04 + scotopic)}; }

State after(const State& s, double goal, double scotopic, double seconds) {
    const auto lag = [&](double from, double to, double tau) { return to + (from - to) * std::exp(-seconds / tau); };
    return {lag(s.cones, goal, 0.080), lag(s.rods, scotopic, 0.150),
            pigment_after(s.cone_pigment, goal, 110, 2e6, seconds),
            pigment_after(s.rod_pigment, scotopic, 400, 0.04, seconds)};
}

Appearance::Appearance(const State& state, double rod_constant)
    : state_(state),
      cone_sigma_(pattanaik::cone_sigma(state.cones)),
      rod_sigma_(pattanaik::rod_sigma(state.rods, rod_constant)) {
    const double display_sigma = pattanaik::cone_sigma(kDisplayAdaptation);
    const double display_white = response(kWhite * kDisplayAdaptation, display_sigma),
                 display_black = response(kBlack * kDisplayAdaptation, display_sigma);
    const auto scene = [&](double factor) {
        return state.cone_pigment * response(factor * state.cones, cone_sigma_) +
               state.rod_pigment * response(factor * state.rods, rod_sigma_);
    };
    const double white = scene(kWhite), black = scene(kBlack), span = (display_white - display_black) / (white - black);
    if (white > display_white)
        scale_ = std::min(span, 1.0), offset_ = display_white - white * scale_;
    else if (black < display_black)
        scale_ = std::min(span, 1.0), offset_ = display_black - black * scale_;
}

double Appearance::cones(double luminance) const {
    return scale_ * state_.cone_pigment * response(luminance, cone_sigma_);
}
double Appearance::rods(double scotopic) const { return scale_ * state_.rod_pigment * response(scotopic, rod_sigma_); }

Shown Appearance::operator()(double luminance, double scotopic) const {
    const double display_sigma = pattanaik::cone_sigma(kDisplayAdaptation), n = kExponent;
    const double display_range =
        response(kWhite * kDisplayAdaptation, display_sigma) - response(kBlack * kDisplayAdaptation, display_sigma);
    const double x = excitation(luminance, cone_sigma_), from_cones = cones(luminance), from_rods = rods(scotopic);
    const double shown = std::clamp(from_cones + from_rods + offset_, 0.0, 0.9999999);
    const double colour = state_.cone_pigment * n * x / ((1 + x) * (1 + x)) / (display_range / std::log10(32.0));
    return {display_sigma / (kWhite * kDisplayAdaptation) * std::pow(shown / (1 - shown), 1 / n), colour,
            from_cones + from_rods > 0 ? from_cones / (from_cones + from_rods) : 1};
}

}  // namespace vesper::analysis::pattanaik
