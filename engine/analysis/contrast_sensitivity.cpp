#include "analysis/contrast_sensitivity.h"

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/parallel.h"
#include "vision/thresholds.h"

namespace vesper::analysis {
namespace {

// Barten 1999; ITU-R BT.2246-7, annex 2.
constexpr double kSignalToNoise = 3;                          // k
constexpr double kIntegration = 0.1;                          // T, s
constexpr double kWidestField = 12;                           // X_max, degrees
constexpr double kMostCycles = 15;                            // N_max
constexpr double kQuantumEfficiency = 0.03;                   // eta
constexpr double kNeuralNoise = 3e-8;                         // Phi_0, s deg^2
constexpr double kInhibition = 7;                             // u_0, cycles/degree
constexpr double kPhotons = 1.2274e6;                         // p, 1/(s deg^2 td)
constexpr double kBlur = 0.5 / 60, kBlurOfPupil = 0.08 / 60;  // sigma_0, degrees; C_ab, degrees/mm

constexpr int kStepsPerDecade = 128;  // of the scale
const double kDecades = std::log10(JndScale::kMost / JndScale::kLeast);

}  // namespace

double contrast_sensitivity(double frequency, double luminance, const ContrastEye& eye) {
    if (!(frequency > 0) || !(luminance > 0)) return 0;
    const double field2 = eye.field * eye.field;
    const double pupil = 5 - 3 * std::tanh(0.4 * std::log10(luminance * field2 / 1600));  // mm
    // Trolands, with the Stiles-Crawford effect.
    const double td = kPi / 4 * pupil * pupil * luminance * (1 - std::pow(pupil / 9.7, 2) + std::pow(pupil / 12.4, 4));
    const double blur = std::hypot(kBlur, kBlurOfPupil * pupil);
    const double optics = std::exp(-2 * kPi * kPi * blur * blur * frequency * frequency) /
                          (eye.scatters ? vision::cie_modulation(std::max(frequency, 0.05), *eye.scatters) : 1);
    const double inhibition = -std::expm1(-std::pow(frequency / kInhibition, 2));
    const double per_area = 1 / field2 + 1 / summation_area(frequency);  // 1/deg^2
    const double noise =
        2 / kIntegration * per_area * (1 / (kQuantumEfficiency * kPhotons * td) + kNeuralNoise / inhibition);
    return optics / (kSignalToNoise * std::sqrt(noise) * vision::age_factor(eye.age));
}

double summation_area(double frequency) {
    return 1 / (1 / (kWidestField * kWidestField) + std::pow(frequency / kMostCycles, 2));
}

double peak_sensitivity(double luminance, const ContrastEye& eye) {
    // One peak between these: thirds are left out until it is known to 0.01 %.
    double low = std::log(0.05), high = std::log(60);
    const auto at = [&](double ln) { return contrast_sensitivity(std::exp(ln), luminance, eye); };
    while (high - low > 0.02) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        (at(a) < at(b) ? low : high) = at(a) < at(b) ? a : b;
    }
    return at((low + high) / 2);
}

JndScale::JndScale(const ContrastEye& eye) : eye_(eye) {
    const int steps = int(std::lround(kDecades * kStepsPerDecade));
    const double step = std::log(10) / kStepsPerDecade;
    peaks_.resize(size_t(steps) + 1);
    in_parallel(peaks_.size(), kStepsPerDecade, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            peaks_[i] = peak_sensitivity(kLeast * std::pow(10, double(i) / kStepsPerDecade), eye);
    });
    jnds_.push_back(0);
    for (size_t i = 1; i < peaks_.size(); ++i) jnds_.push_back(jnds_.back() + step * (peaks_[i - 1] + peaks_[i]) / 2);
}

double JndScale::jnd(double luminance) const { return luminance > kLeast ? at(jnds_, luminance) : 0; }
double JndScale::peak(double luminance) const { return at(peaks_, luminance); }

double JndScale::at(const std::vector<double>& table, double luminance) const {
    const double place = std::log10(std::clamp(luminance, kLeast, kMost) / kLeast) * kStepsPerDecade;
    const size_t i = std::min(size_t(place), table.size() - 2);
    return std::lerp(table[i], table[i + 1], place - double(i));
}

double JndScale::luminance(double jnd) const {
    const auto above = std::upper_bound(jnds_.begin() + 1, jnds_.end() - 1, jnd);
    const double low = *(above - 1), part = std::clamp((jnd - low) / (*above - low), 0.0, 1.0);
    return kLeast * std::pow(10, (double(above - 1 - jnds_.begin()) + part) / kStepsPerDecade);
}

}  // namespace vesper::analysis
