#include "vision/glare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/angle.h"

namespace vesper::vision {
namespace {

double square(double x) { return x * x; }
double fourth(double x) { return square(square(x)); }
double three_halves(double x) { return x * std::sqrt(x); }

// Gauss-Legendre nodes and weights of five points on [-1, 1].
constexpr std::array<double, 5> kNodes{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                       0.9061798459386640};
constexpr std::array<double, 5> kWeights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                         0.2369268850561891};

constexpr double kSmallest = 1e-4;  // deg: the narrowest core, that of CIE, is 0.0046 deg wide
constexpr int kPerDecade = 64;

}  // namespace

double cie_total_glare(double t, const ScatteringEye& eye) {
    const double a = fourth(eye.age / 70), p = eye.pigmentation, lens = 1 + 1.6 * a;
    const double wide = 1 + square(t / 0.1);
    const double core =
        (1 - 0.08 * a) * (9.2e6 / three_halves(1 + square(t / 0.0046)) + 1.5e5 / three_halves(1 + square(t / 0.045)));
    const double scatter = lens * (400 / wide + 3e-8 * square(t));
    const double iris = p * lens * (1300 / three_halves(wide) + 0.8 / std::sqrt(wide)) + 2.5e-3 * p;
    return (core + scatter + iris) / (1 + p * (0.0417 + 0.055 * a));
}

double cie_modulation(double frequency, const ScatteringEye& eye) {
    const double a = fourth(eye.age / 70), p = eye.pigmentation, lens = 1 + 1.6 * a;
    // Transforms of (1 + (t / width)^2)^-n with n of 3/2, 1 and 1/2, over 2 pi width^2, of x = 2 pi width frequency.
    const auto area = [](double width) { return 2 * kPi * square(width * kRadiansPerDegree); };
    const auto narrow = [&](double width) { return area(width) * std::exp(-2 * kPi * width * frequency); };
    const double x = 2 * kPi * 0.1 * frequency, wide = x < 6 ? std::cyl_bessel_k(0, x) : 0;  // below 0.0013 beyond
    const double core = (1 - 0.08 * a) * (9.2e6 * narrow(0.0046) + 1.5e5 * narrow(0.045));
    const double scatter = lens * 400 * area(0.1) * wide;
    const double iris = p * lens * (1300 * narrow(0.1) + 0.8 * narrow(0.1) / x);
    return (core + scatter + iris) / (1 + p * (0.0417 + 0.055 * a));
}

double cie_general_glare(double t, const ScatteringEye& eye) {
    const double p = eye.pigmentation;
    return 10 / (t * t * t) + (5 / square(t) + 0.1 * p / t) * (1 + fourth(eye.age / 62.5)) + 2.5e-3 * p;
}

double cie_small_angle_glare(double t, double age) { return cie_general_glare(t, {age, 0}); }

double cie_age_adjusted_glare(double t, double age) { return 10 * (1 + fourth(age / 70)) / square(t); }

double en13201_glare(double theta, double age) {
    if (theta > 60 || theta < 0.1) return 0;
    const double inverse = 1 / theta;
    if (theta > 1.5) return 9.86 * (1 + std::pow(age / 66.4, 4)) * inverse * inverse;
    return (10 * inverse + 5 * (1 + std::pow(age / 62.5, 4))) * inverse * inverse;
}

double threshold_increment(double veil, double average_luminance) {
    return average_luminance > 5 ? 95 * veil / std::pow(average_luminance, 1.05)
                                 : 65 * veil / std::pow(average_luminance, 0.8);
}

double spencer_core(double t) { return 2.61e6 * std::exp(-square(t / 0.02)); }
double spencer_corona(double t) { return 20.91 / ((t + 0.02) * (t + 0.02) * (t + 0.02)); }
double spencer_bloom(double t) { return 72.37 / square(t + 0.02); }
double spencer_halo(double t, double nanometres) {
    return 436.9 * (568 / nanometres) * std::exp(-19.75 * square(t - 3 * nanometres / 568));
}

SpencerWeights spencer_weights(SpencerState state) {
    switch (state) {
        case SpencerState::Photopic:
            return {0.384, 0.478, 0.138, 0};
        case SpencerState::Mesopic:
            return {0.368, 0.478, 0.138, 0.016};
        case SpencerState::Scotopic:
            break;
    }
    return {0.282, 0.478, 0.207, 0.033};
}

double spencer_smooth_glare(double t, const SpencerWeights& w) {
    return w.core * spencer_core(t) + w.corona * spencer_corona(t) + w.bloom * spencer_bloom(t);
}

double spencer_glare(double t, SpencerState state, double nanometres) {
    const SpencerWeights w = spencer_weights(state);
    return spencer_smooth_glare(t, w) + w.halo * spencer_halo(t, nanometres);
}

namespace {

// Integral over the ring from `low` to `high`: 2 pi f sin(theta) d theta.
double ring(const std::function<double(double)>& psf, double low, double high) {
    double sum = 0;
    for (size_t i = 0; i < kNodes.size(); ++i) {
        const double t = 0.5 * (low + high) + 0.5 * (high - low) * kNodes[i];
        sum += kWeights[i] * psf(t) * std::sin(t * kRadiansPerDegree);
    }
    return std::numbers::pi * (high - low) * kRadiansPerDegree * sum;
}

double ward_scattered(double t) { return std::cos(t * kRadiansPerDegree) / square(std::max(t, 0.5)); }

}  // namespace

double ward_veil(double t) {
    constexpr double kCore = 5e-4;  // deg: far below any pixel
    static const double scattered = EyeScatter(ward_scattered).total();
    return 0.92 * std::exp(-square(t / kCore)) / (std::numbers::pi * square(kCore * kRadiansPerDegree)) +
           0.08 * ward_scattered(t) / scattered;
}

EyeScatter::EyeScatter(std::function<double(double)> psf) : psf_(std::move(psf)), angles_{0}, sums_{0} {
    for (int i = 0; angles_.back() < 90; ++i) {
        const double next = std::min(90.0, kSmallest * std::pow(10.0, double(i) / kPerDecade));
        sums_.push_back(sums_.back() + ring(psf_, angles_.back(), next));
        angles_.push_back(next);
    }
    scale_ = 1 / sums_.back();
}

double EyeScatter::integral(double theta) const {
    if (theta <= 0) return 0;
    if (theta >= 90) return sums_.back();
    const size_t i = size_t(std::upper_bound(angles_.begin(), angles_.end(), theta) - angles_.begin()) - 1;
    return sums_[i] + ring(psf_, angles_[i], theta);
}

}  // namespace vesper::vision
