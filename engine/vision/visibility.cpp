#include "vision/visibility.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angle.h"

namespace vesper::vision {
namespace {

// Flux and luminance functions: their square roots, cd/m^2 (square root) per arc minute and without.
struct Functions {
    double flux, luminance;
};

Functions functions_of(double lb) {
    const double l = std::log10(lb);
    if (lb >= 0.6)
        return {std::log10(4.1925 * std::pow(lb, 0.1556)) + 0.1684 * std::pow(lb, 0.5867),
                0.05946 * std::pow(lb, 0.466)};
    if (lb > 0.00418) return {std::pow(10.0, -0.072 + 0.3372 * l + 0.0866 * l * l), std::pow(10.0, -1.256 + 0.319 * l)};
    return {std::pow(10.0, 0.028 + 0.173 * l), std::pow(10.0, -0.891 + 0.5275 * l + 0.0227 * l * l)};
}

// Blondel and Rey's time constant, s.
double exposure_constant(double arc_minutes, double lb) {
    const double x = std::log10(arc_minutes) + 0.523, y = std::log10(lb) + 6;
    const double a1 = 0.36 - 0.0972 * x * x / (x * x - 2.513 * x + 2.7895);
    const double a2 = 0.355 - 0.1217 * y * y / (y * y - 10.4 * y + 52.28);
    return std::sqrt(a1 * a1 + a2 * a2) / 2.1;
}

double age_factor_of_targets(double age) {
    if (age > 64) return (age - 56.6) * (age - 56.6) / 116.3 + 1.43;
    const double over = std::max(age, 23.0) - 19;
    return over * over / 2160 + 0.99;
}

// Without age.
double bright_threshold(double lb, const Target& t, double seconds) {
    const Functions f = functions_of(lb);
    const double root = f.flux / t.size + f.luminance;
    const bool long_and_large = seconds >= 2;
    const double exposure = long_and_large ? 1 : (exposure_constant(t.size, lb) + seconds) / seconds;
    return t.probability * root * root * exposure;
}

// Less light is needed to be darker than the background than to be brighter.
double contrast_polarity(double lb, const Target& t) {
    if (lb <= 0.004) return 1;
    const double l = std::log10(lb), c = lb >= 0.1 ? 0.125 : 0.075;
    const double m = std::pow(10.0, -std::pow(10.0, -(c * (l + 1) * (l + 1) + 0.0245)));
    const double beta = 0.6 * std::pow(lb, -0.1488);
    return 1 - m * std::pow(t.size, -beta) / (2.4 * bright_threshold(lb, t, 2));
}

}  // namespace

double target_threshold(double background, const Target& target) {
    const double bright = bright_threshold(background, target, target.seconds) * age_factor_of_targets(target.age);
    return target.darker ? bright * contrast_polarity(background, target) : bright;
}

double visibility_level(double target_luminance, double background, Target target) {
    const double difference = target_luminance - background;
    target.darker = difference < 0;
    return difference / target_threshold(background, target);
}

std::optional<double> bounded_visibility_level(double target_luminance, double background, Target target) {
    target.size = std::min(target.size, kLargestTarget);
    const bool known = std::isfinite(target_luminance) && target.size > 0 && background >= kDarkestBackground &&
                       background <= kBrightestBackground;
    if (!known) return std::nullopt;
    target.darker = target_luminance < background;
    const double threshold = target_threshold(background, target);
    if (!(threshold > 0)) return std::nullopt;
    return (target_luminance - background) / threshold;
}

double disc_minutes(double steradians) { return 2 * std::sqrt(steradians / std::numbers::pi) * kDegreesPerRadian * 60; }

}  // namespace vesper::vision
