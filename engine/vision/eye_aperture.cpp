#include "vision/eye_aperture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/angle.h"
#include "vision/fourier.h"

namespace vesper::vision {
namespace {

using glm::dvec2;

constexpr double kWidestPupil = 9, kUsualPupil = 5;                    // mm
constexpr double kSample = EyeAperture::kWindow / EyeAperture::kSide;  // mm

// Numbers that depend on nothing but two others (SplitMix64, Steele et al. 2014), [0, 1).
double chance(uint64_t seed, uint64_t index) {
    uint64_t z = seed * 0xD1342543DE82EF95u + (index + 1) * 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// Smooth noise about 0, within 1: values at whole numbers, a cubic between.
double noise(double x, uint64_t seed) {
    const double whole = std::floor(x), t = x - whole;
    const auto value = [&](double i) { return 2 * chance(seed, uint64_t(int64_t(i))) - 1; };
    return glm::mix(value(whole), value(whole + 1), t * t * (3 - 2 * t));
}

double octaves(double x, uint64_t seed) {
    return (noise(x, seed) + noise(2 * x, seed + 1) / 2 + noise(4 * x, seed + 2) / 4) / 1.75;
}

// Where the vitreous humour is after the movements of the eye so far, mm: every 1.2 s on average the eye turns, what
// floats in it lags behind by up to half a millimetre and comes back.
dvec2 vitreous_drift(double seconds, uint64_t seed) {
    constexpr double kEvery = 1.2, kBack = 0.5, kFarthest = 0.5;  // s, s, mm
    const auto now = int64_t(std::floor(seconds / kEvery));
    dvec2 drift(0);
    for (int64_t k = now - 8; k <= now; ++k) {  // what is older has come back
        const uint64_t event = uint64_t(k) * 3;
        const double since = (seconds - (double(k) + chance(seed, event)) * kEvery) / kBack;
        if (since <= 0) continue;
        const double far = kFarthest * chance(seed, event + 1) * since * std::exp(1 - since),
                     turn = kTwoPi * chance(seed, event + 2);
        drift += far * dvec2(std::cos(turn), std::sin(turn));
    }
    return drift;
}

// Takes an area out of the samples about a place, in shares that are linear in where it is.
void take(std::vector<double>& transmitted, dvec2 place, double area) {
    constexpr int kSide = EyeAperture::kSide;
    const dvec2 at = place / kSample + 0.5 * kSide - 0.5, first = glm::floor(at), part = at - first;
    const double taken = area / (kSample * kSample);
    for (int i = 0; i < 4; ++i) {
        const int x = int(first.x) + i % 2, y = int(first.y) + i / 2;
        if (x < 0 || y < 0 || x >= kSide || y >= kSide) continue;
        transmitted[size_t(y) * kSide + size_t(x)] -=
            taken * (i % 2 ? part.x : 1 - part.x) * (i / 2 ? part.y : 1 - part.y);
    }
}

}  // namespace

double restless_pupil(double diameter, double seconds, uint32_t seed) {
    const double p = std::clamp(diameter, 1.0, 0.98 * EyeAperture::kWindow);
    // Of time alone: of t / p a change of p late in a drive would move it by many turns.
    const double moved =
        p + 0.35 * octaves(2 * seconds / kUsualPupil, seed) * (kWidestPupil / p) * std::sqrt(1 - p / kWidestPupil);
    return std::clamp(moved, 1.0, 0.98 * EyeAperture::kWindow);
}

EyeAperture::EyeAperture(const ApertureSettings& settings) : settings_(settings) {
    std::mt19937 random(settings.seed);
    const auto unit = [&] { return double(random()) * 0x1p-32; };
    const auto scatter = [&](std::vector<Particle>& particles, int count, double smallest, double largest) {
        for (int i = 0; i < count; ++i) {
            const double r = 0.5 * kWindow * std::sqrt(unit()), turn = kTwoPi * unit(),
                         radius = glm::mix(smallest, largest, unit());
            particles.push_back({r * dvec2(std::cos(turn), std::sin(turn)), std::numbers::pi * radius * radius});
        }
    };
    scatter(cornea_, 100, 0.005, 0.012);
    scatter(lens_, 750, 0.005, 0.015);
    scatter(vitreous_, 250, 0.006, 0.018);
    for (int i = 0; i < 200; ++i) {
        // At random: 200 in order would be a grating, with a ring at a tenth of the angle that thousands of them have
        // theirs at.
        const double turn = kTwoPi * unit(), inner = 1.5 + unit();  // mm
        const dvec2 along(std::cos(turn), std::sin(turn));
        const double width = 0.012 * unit();
        fibres_.push_back({inner * along, 0.5 * kWindow * along, width});
    }
    for (int i = 0; settings.lashes && i < 14; ++i) {
        const double x = glm::mix(-3.0, 3.0, (i + unit()) / 14), tip = glm::mix(-1.0, 1.0, unit()),
                     lean = 0.25 * x + 0.5 * (unit() - 0.5);
        lashes_.push_back({{x, tip}, {x + lean, 0.5 * kWindow}, 0.06});
    }
}

std::vector<std::complex<double>> EyeAperture::amplitude(double diameter, double seconds) const {
    std::vector<double> transmitted(size_t(kSide) * kSide, 1);
    const auto draw = [&](const std::vector<Fibre>& fibres) {
        for (const Fibre& f : fibres) {
            const int steps = int(glm::length(f.to - f.from) / kSample) + 1;
            const dvec2 step = (f.to - f.from) / double(steps);
            for (int i = 0; i < steps; ++i) take(transmitted, f.from + (i + 0.5) * step, f.width * glm::length(step));
        }
    };
    const uint64_t seed = uint64_t(settings_.seed) << 32;
    // The lens is never quite at rest: it shears by up to 2 %.
    const double shear = 0.02 * octaves(0.7 * seconds, seed + 10), stretch = 0.01 * octaves(0.5 * seconds, seed + 20);
    const dvec2 drift = vitreous_drift(seconds, seed + 30);
    for (const Particle& p : cornea_) take(transmitted, p.place, p.area);
    for (const Particle& p : lens_) take(transmitted, p.place * (1 + stretch) + shear * dvec2(p.place.y, 0), p.area);
    for (const Particle& p : vitreous_) take(transmitted, p.place + drift, p.area);
    draw(fibres_);
    draw(lashes_);

    std::vector<std::complex<double>> amplitude(transmitted.size());
    const double edge = 3 * kSample, chirp = std::numbers::pi * kDefocus * 1e-3 / kWavelength;  // dioptres are 1/m
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const dvec2 at = (dvec2(x, y) + 0.5 - 0.5 * kSide) * kSample;
            const double r2 = glm::dot(at, at), open = glm::smoothstep(-edge, edge, 0.5 * diameter - std::sqrt(r2));
            const size_t i = size_t(y) * kSide + size_t(x);
            if (open > 0) amplitude[i] = std::polar(open * std::max(transmitted[i], 0.0), chirp * r2);
        }
    return amplitude;
}

std::vector<double> far_field(const std::vector<std::complex<double>>& amplitude, int side) {
    const size_t n = size_t(side);
    const Complexes spectrum = spectrum_of(amplitude, n, n);
    std::vector<double> intensity(n * n);
    for (size_t x = 0; x < n; ++x)
        for (size_t y = 0; y < n; ++y)
            intensity[(y + n / 2) % n * n + (x + n / 2) % n] = std::norm(spectrum[x * n + y]);
    return intensity;
}

}  // namespace vesper::vision
