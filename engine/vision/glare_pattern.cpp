#include "vision/glare_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "base/angle.h"
#include "base/luminance.h"
#include "photometry/observer.h"

namespace vesper::vision {
namespace {

using glm::dvec3, glm::vec3;
using Rows = std::vector<std::vector<float>>;  // row by row, a value for each column

constexpr int kColumns = GlarePattern::kColumns, kRows = GlarePattern::kRows;
constexpr double kStep = kTwoPi / kColumns;  // of azimuth, and of ln theta from row to row

// How strong needles and colours may be: a tenth of the veil, 0.5 * (1 - 0.8), is left where both are darkest, and the
// pyramid that makes the veil is up to 8 % off.
constexpr double kNeedles = 0.8, kColours = 0.5, kLeastNeedle = 0.1;
// Needles fade out from here to kReach, degrees.
constexpr double kFade = 4;

double middle(int row) { return GlarePattern::angle(row + 0.5); }
double fade(double theta) { return 1 - glm::smoothstep(kFade, double(GlarePattern::kReach), theta); }

// Spencer's halo in colours: f3 of each wavelength with its part of white light.
dvec3 coloured_halo(double theta) {
    static const std::array<dvec3, photometry::kWavelengths> white = photometry::white_light();
    dvec3 sum(0);
    for (int i = 0; i < photometry::kWavelengths; ++i)
        sum += spencer_halo(theta, photometry::wavelength(i)) * white[size_t(i)];
    return sum;
}

// The intensity of the far field along rings, over the mean of each: rows first .. first + count of the pattern, for
// kWavelength. Beyond what the samples tell, the last ring goes on outwards.
Rows rings_of(const std::vector<double>& intensity, int first, int count) {
    constexpr int kSide = EyeAperture::kSide;
    const double sample = EyeAperture::kWavelength / EyeAperture::kWindow / kRadiansPerDegree;  // degrees
    const auto at = [&](double x, double y) {
        const double left = std::floor(x), top = std::floor(y), u = x - left, v = y - top;
        const double* p = &intensity[size_t(top + kSide / 2) * kSide + size_t(left + kSide / 2)];
        return glm::mix(glm::mix(p[0], p[1], u), glm::mix(p[kSide], p[kSide + 1], u), v);
    };
    Rows rows;
    std::vector<glm::dvec2> sides;  // the directions of the samples of a ring
    for (int row = first; row < first + count; ++row) {
        if (GlarePattern::angle(row + 1) / sample > 0.48 * kSide) {
            rows.push_back(rows.back());
            continue;
        }
        // As many samples of the cell as it covers in the far field.
        const int parts = int(std::ceil(GlarePattern::angle(row + 1) * kStep / sample));
        if (sides.size() != size_t(parts * kColumns)) {
            sides.clear();
            for (int i = 0; i < parts * kColumns; ++i)
                sides.emplace_back(std::cos(kStep * (i + 0.5) / parts), std::sin(kStep * (i + 0.5) / parts));
        }
        std::vector<float> ring(size_t(kColumns), 0);
        double sum = 0;
        for (int v = 0; v < parts; ++v) {
            const double radius = GlarePattern::angle(row + (v + 0.5) / parts) / sample;
            for (int i = 0; i < parts * kColumns; ++i) {
                const double value = at(radius * sides[size_t(i)].x, radius * sides[size_t(i)].y);
                ring[size_t(i / parts)] += float(value);
                sum += value;
            }
        }
        const float share = sum > 0 ? float(kColumns / sum) : 0;
        for (float& value : ring) value = sum > 0 ? value * share : 1;
        rows.push_back(std::move(ring));
    }
    return rows;
}

// White light through rings that are those of kWavelength, larger or smaller by the wavelength: along ln theta, a
// convolution.
std::vector<vec3> chromatic(const std::vector<double>& intensity) {
    static const std::array<dvec3, photometry::kWavelengths> white = photometry::white_light();
    const auto shift = [](int i) {
        return std::log(photometry::wavelength(i) * 1e-6 / EyeAperture::kWavelength) / kStep;
    };
    const int most = int(std::ceil(shift(photometry::kWavelengths - 1))), least = int(std::floor(shift(0)));
    std::vector<vec3> kernel(size_t(most - least + 1), vec3(0));
    for (int i = 0; i < photometry::kWavelengths; ++i) {
        const double whole = std::floor(shift(i)), part = shift(i) - whole;
        kernel[size_t(int(whole) - least)] += vec3((1 - part) * white[size_t(i)]);
        if (part > 0) kernel[size_t(int(whole) - least + 1)] += vec3(part * white[size_t(i)]);
    }
    const Rows rings = rings_of(intensity, -most, kRows + most - least);
    std::vector<vec3> modulation(size_t(kRows) * kColumns);
    std::vector<float> sums(3 * size_t(kColumns));
    for (int row = 0; row < kRows; ++row) {
        std::fill(sums.begin(), sums.end(), -1.0f);
        for (int d = least; d <= most; ++d) {
            const vec3 k = kernel[size_t(d - least)];
            const std::vector<float>& ring = rings[size_t(row - d + most)];
            for (size_t c = 0; c < 3; ++c)
                for (size_t column = 0; column < size_t(kColumns); ++column)
                    sums[c * kColumns + column] += k[int(c)] * ring[column];
        }
        for (int c = 0; c < 3; ++c) {
            // Colours that Rec. 709 does not have are cut off, and the rest is brought to a mean of 0 again.
            double sum = 0;
            float* values = &sums[size_t(c) * kColumns];
            for (size_t column = 0; column < size_t(kColumns); ++column)
                sum += double(values[column] = std::max(values[column], -1.0f));
            const auto scale = float(1 / (1 + sum / kColumns));
            for (size_t column = 0; column < size_t(kColumns); ++column)
                modulation[size_t(row) * kColumns + column][c] = (1 + values[column]) * scale - 1;
        }
    }
    return modulation;
}

}  // namespace

double GlarePattern::angle(double row) { return kReach * std::exp((row - kRows) * kStep); }
double GlarePattern::row_of(double degrees) { return kRows + std::log(degrees / kReach) / kStep; }

double halo_share(double diameter) {
    return spencer_weights(SpencerState::Scotopic).halo * std::clamp((diameter - 3) / (4.9 - 3), 0.0, 1.0);
}

double spencer_veil(double theta, SpencerState state) {
    constexpr double kWide = 2.2;  // degrees: nearly nothing at kReach
    const SpencerWeights w = spencer_weights(state);
    const double t = theta / kWide, area = std::numbers::pi * kWide * kWide * kRadiansPerDegree * kRadiansPerDegree;
    return spencer_smooth_glare(theta, w) + w.halo / area * std::exp(-t * t);
}

GlarePattern temporal_pattern(const EyeScatter& smooth, const EyeAperture& aperture, double diameter, double seconds) {
    std::vector<dvec3> colours;
    double strongest = 0;
    for (int row = 0; row < kRows; ++row) {
        const dvec3 halo = coloured_halo(middle(row)), colour = halo - luminance(halo);
        colours.push_back(colour);
        for (int c = 0; c < 3; ++c) strongest = std::max(strongest, -colour[c] / smooth(middle(row)));
    }
    const double share = std::min(halo_share(diameter), kColours / strongest);
    GlarePattern pattern;
    for (int row = 0; row < kRows; ++row) {
        const dvec3 ring = share * colours[size_t(row)];
        pattern.ring.emplace_back(ring);
        pattern.needles.emplace_back(kNeedles * fade(middle(row)) * (smooth(middle(row)) + ring));
    }
    pattern.modulation = chromatic(far_field(aperture.amplitude(diameter, seconds), EyeAperture::kSide));
    return pattern;
}

GlarePattern spencer_pattern(const EyeScatter& smooth, SpencerState state, uint32_t seed) {
    constexpr int kLines = 200;
    constexpr double kWidth = 0.04;  // degrees: a pixel of a picture of 40 degrees
    const SpencerWeights w = spencer_weights(state);
    const double scale = 1 / smooth.total();
    std::mt19937 random(seed);
    std::vector<std::pair<double, double>> lines;  // azimuth and intensity
    for (int i = 0; i < kLines; ++i) {
        const double azimuth = kTwoPi * double(random()) * 0x1p-32;
        lines.emplace_back(azimuth, double(random()) * 0x1p-32);
    }
    // Colours of single wavelengths are beyond Rec. 709: all of the ring is less colourful, as far as that leaves light
    // in every channel.
    double saturation = 1;
    for (int row = 0; row < kRows; ++row) {
        const double theta = middle(row);
        const dvec3 halo = w.halo * coloured_halo(theta);
        const double grey = luminance(halo), spare = spencer_smooth_glare(theta, w) -
                                                     kNeedles * w.corona * spencer_corona(theta) + grey -
                                                     kLeastNeedle * spencer_veil(theta, state);
        for (int c = 0; c < 3; ++c)
            if (halo[c] < grey) saturation = std::min(saturation, spare / (grey - halo[c]));
    }
    GlarePattern pattern;
    for (int row = 0; row < kRows; ++row) {
        const double theta = middle(row), half = std::max(kWidth / theta, kStep);  // rad
        const dvec3 halo = w.halo * coloured_halo(theta), shown = glm::mix(dvec3(luminance(halo)), halo, saturation);
        pattern.ring.emplace_back(scale * (spencer_smooth_glare(theta, w) + shown) - smooth(theta));
        pattern.needles.emplace_back(kNeedles * fade(theta) * scale * w.corona * spencer_corona(theta));
        std::vector<double> ring(kColumns, 0);
        double sum = 0;
        for (const auto& [azimuth, intensity] : lines) {
            const int first = int(std::ceil((azimuth - half) / kStep - 0.5)),
                      last = int(std::floor((azimuth + half) / kStep - 0.5));
            for (int column = first; column <= last; ++column) {
                const double part = intensity * (1 - std::abs(kStep * (column + 0.5) - azimuth) / half);
                ring[size_t((column + kColumns) % kColumns)] += part, sum += part;
            }
        }
        for (double value : ring) pattern.modulation.emplace_back(float(value * kColumns / sum - 1));
    }
    return pattern;
}

}  // namespace vesper::vision
