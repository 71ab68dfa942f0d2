#include "vision/thresholds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vesper::vision {
namespace {

double power_of_ten(double exponent) { return std::pow(10.0, exponent); }

double rods_log10(double l, double weber) {
    if (l <= -3.94) return -2.86;
    return l < weber ? std::pow(std::max(0.405 * l + 1.6, 0.0), 2.18) - 2.86 : l - 0.395;
}

double cones_log10(double l, double weber) {
    if (l <= -2.6) return -0.72;
    return l < weber ? std::pow(std::max(0.249 * l + 0.65, 0.0), 2.7) - 0.72 : l - 1.255;
}

}  // namespace

double cone_threshold(double luminance, ThresholdBreaks breaks) {
    return power_of_ten(cones_log10(std::log10(luminance), breaks.cones));
}

double rod_threshold(double luminance, ThresholdBreaks breaks) {
    return power_of_ten(rods_log10(std::log10(luminance), breaks.rods));
}

double human_threshold(double luminance, ThresholdBreaks breaks) {
    const double l = std::log10(luminance);
    if (breaks == ThresholdBreaks::continuous())
        return power_of_ten(std::min(cones_log10(l, breaks.cones), rods_log10(l, breaks.rods)));
    if (luminance < 1.148e-4) return 1.38e-3;
    return power_of_ten(l < -0.0184 ? rods_log10(l, breaks.rods) : cones_log10(l, breaks.cones));
}

double pupil_moon_spencer(double luminance) { return 4.9 - 3 * std::tanh(0.4 * std::log10(luminance)); }

double pupil_watson_yellott(double luminance, double degrees2, double age, bool two_eyes) {
    const double flux = luminance * degrees2 * (two_eyes ? 1 : 0.1);
    const double x = std::pow(flux / 846, 0.41);
    const double young = 7.75 - 5.75 * x / (x + 2);
    return young + (age - 28.58) * (0.021323 - 0.0095623 * young);
}

double trolands(double luminance, double diameter) { return luminance * std::numbers::pi / 4 * diameter * diameter; }

double trolands(double luminance) { return trolands(luminance, pupil_moon_spencer(luminance)); }

double scotopic_luminance(double x, double y, double z) {
    return x > 0 ? std::max(y * (1.33 * (1 + (y + z) / x) - 1.68), 0.0) : 0;
}

double acuity(double luminance) { return 17.25 * std::atan(1.4 * std::log10(luminance) + 0.35) + 25.72; }

double age_factor(double years) {
    if (years > 64) {
        const double old = std::min(years, 75.0) - 56.6;
        return old * old / 116.3 + 1.43;
    }
    const double over = std::max(years, 23.0) - 19;
    return std::max(1.0, over * over / 2160 + 0.99);
}

}  // namespace vesper::vision
