// Sums over an equirectangular picture. SPDX-License-Identifier: MIT
#include "photometry/environment.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/angle.h"
#include "base/error.h"
#include "base/luminance.h"
#include "io/hdr_image.h"

namespace vesper::photometry {
namespace {

glm::dvec3 pixel(const Environment& e, uint32_t x, uint32_t y) {
    const float* c = &e.rgb[(static_cast<size_t>(y) * e.width + x) * 3];
    return {c[0], c[1], c[2]};
}

/// Integral of sin(polar angle) from one row boundary to another of `rows`.
double band(double from, double to, double rows) { return std::cos(kPi * from / rows) - std::cos(kPi * to / rows); }

/// Calls f(direction, luminance, solid angle) for every pixel.
template <class F>
void for_every_pixel(const Environment& e, F f) {
    for (uint32_t y = 0; y < e.height; ++y) {
        const double angle = solid_angle_of_row(e, y);
        for (uint32_t x = 0; x < e.width; ++x) f(direction_at(e, {x + 0.5, y + 0.5}), pixel(e, x, y), angle);
    }
}

/// Mean over the solid angle of every pixel of a smaller picture.
Environment averaged(const Environment& e, uint32_t width) {
    const uint32_t height = width / 2;
    Environment small{width, height, std::vector<float>(static_cast<size_t>(width) * height * 3), e.rotation};
    const double step = static_cast<double>(e.width) / width;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const double top = y * step, bottom = std::min(top + step, double(e.height)), left = x * step,
                         right = left + step;
            glm::dvec3 sum(0);
            double weights = 0;
            for (auto j = static_cast<uint32_t>(top); j < e.height && j < bottom; ++j) {
                const double rows = band(std::max(top, double(j)), std::min(bottom, j + 1.0), e.height);
                for (auto i = static_cast<uint32_t>(left); i < e.width && i < right; ++i) {
                    const double weight = rows * (std::min(right, i + 1.0) - std::max(left, double(i)));
                    sum += weight * pixel(e, i, j), weights += weight;
                }
            }
            for (int c = 0; c < 3; ++c)
                small.rgb[(static_cast<size_t>(y) * width + x) * 3 + static_cast<size_t>(c)] =
                    static_cast<float>(sum[c] / weights);
        }
    return small;
}

}  // namespace

Environment make_environment(const io::HdrImage& image, uint64_t* cleaned) {
    if (image.height < 1 || image.width != 2 * uint64_t{image.height})
        throw Error("a picture of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                    " px is no equirectangular sky: it must be twice as wide as high");
    Environment made{image.width, image.height, image.rgb};
    uint64_t bad = 0;
    for (size_t i = 0; i < made.rgb.size(); i += 3) {
        bool clean = true;
        for (size_t c = 0; c < 3; ++c)
            if (!(made.rgb[i + c] >= 0) || !std::isfinite(made.rgb[i + c])) made.rgb[i + c] = 0, clean = false;
        bad += !clean;
    }
    if (cleaned) *cleaned += bad;
    return made.width > kMaxEnvironmentWidth ? averaged(made, kMaxEnvironmentWidth) : made;
}

glm::dvec3 direction_of(double azimuth, double elevation) {
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), -std::cos(azimuth) * std::cos(elevation)};
}

glm::dvec3 direction_at(const Environment& e, glm::dvec2 place) {
    return direction_of((place.x / e.width - 0.5) * 2 * kPi + e.rotation, (0.5 - place.y / e.height) * kPi);
}

glm::dvec2 place_of(const Environment& e, glm::dvec3 d) {
    double turn = (std::atan2(d.x, -d.z) - e.rotation) / (2 * kPi) + 0.5;
    turn -= std::floor(turn);
    const double elevation = std::atan2(d.y, std::hypot(d.x, d.z));
    return {turn * e.width, (0.5 - elevation / kPi) * e.height};
}

double solid_angle_of_row(const Environment& e, uint32_t y) { return 2 * kPi / e.width * band(y, y + 1.0, e.height); }

glm::dvec3 luminance_of(const Environment& e, glm::dvec3 direction) {
    const glm::dvec2 place = place_of(e, direction) - 0.5;
    const glm::dvec2 corner = glm::floor(place), t = place - corner;
    const auto column = [&](int add) { return static_cast<uint32_t>((int64_t(corner.x) + add + e.width) % e.width); };
    const auto row = [&](int add) {
        return static_cast<uint32_t>(std::clamp<int64_t>(int64_t(corner.y) + add, 0, e.height - 1));
    };
    return glm::mix(glm::mix(pixel(e, column(0), row(0)), pixel(e, column(1), row(0)), t.x),
                    glm::mix(pixel(e, column(0), row(1)), pixel(e, column(1), row(1)), t.x), t.y);
}

glm::dvec3 irradiance(const Environment& e, glm::dvec3 n) {
    glm::dvec3 sum(0);
    for_every_pixel(
        e, [&](glm::dvec3 d, glm::dvec3 l, double angle) { sum += l * (std::max(glm::dot(d, n), 0.0) * angle); });
    return sum;
}

Irradiance9 irradiance_polynomial(const Environment& e) {
    // Projections of luminance on the polynomials, times the square of their normalisation and what the cosine lobe
    // leaves of their order: pi, 2 pi / 3, pi / 4 (Ramamoorthi and Hanrahan, eq. 8).
    Irradiance9 sums{};
    glm::dvec3 ground(0);
    for_every_pixel(e, [&](glm::dvec3 d, glm::dvec3 l, double angle) {
        ground += l * (std::max(d.y, 0.0) * angle);
        const double basis[9] = {
            1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
        for (size_t i = 0; i < 9; ++i) sums[i] += l * (basis[i] * angle);
    });
    constexpr double kSquares[9] = {1 / (4 * kPi),  3 / (4 * kPi),  3 / (4 * kPi),  3 / (4 * kPi),  15 / (4 * kPi),
                                    15 / (4 * kPi), 5 / (16 * kPi), 15 / (4 * kPi), 15 / (16 * kPi)};
    constexpr double kLobe[3] = {kPi, 2 * kPi / 3, kPi / 4};
    for (size_t i = 0; i < 9; ++i) sums[i] *= kSquares[i] * kLobe[i == 0 ? 0 : i < 4 ? 1 : 2];
    // What the third and higher orders take from the ground, or give it, goes with (P0 + 3 P1 + 5 P2)(y) / 9: 1 at y =
    // 1, and the least change in the mean square that is. y^2 = 1/3 - (3 z^2 - 1) / 6 - (x^2 - y^2) / 2.
    const glm::dvec3 left = ground - (sums[0] + sums[1] - sums[6] - sums[8]);
    sums[0] += left / 9.0, sums[1] += left / 3.0, sums[6] -= left * (5 / 36.0), sums[8] -= left * (5 / 12.0);
    return sums;
}

glm::dvec3 evaluate(const Irradiance9& c, glm::dvec3 n) {
    const glm::dvec3 e = c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x + c[4] * (n.x * n.y) + c[5] * (n.y * n.z) +
                         c[6] * (3 * n.z * n.z - 1) + c[7] * (n.x * n.z) + c[8] * (n.x * n.x - n.y * n.y);
    return glm::max(e, glm::dvec3(0));
}

double sky_luminance(const Environment& e) {
    double sum = 0, weights = 0;
    for (uint32_t y = 0; 2 * y < e.height; ++y) {
        const double weight = band(y, std::min(y + 1.0, e.height / 2.0), e.height);
        for (uint32_t x = 0; x < e.width; ++x) sum += weight * luminance(pixel(e, x, y)), weights += weight;
    }
    return sum / weights;
}

double horizontal_illuminance(const Environment& e) { return luminance(irradiance(e, {0, 1, 0})); }

Environment scaled(Environment e, double factor) {
    for (float& value : e.rgb) {
        value = static_cast<float>(value * factor);
        if (!std::isfinite(value)) throw Error("the scaled sky is brighter than a float can say");
    }
    return e;
}

}  // namespace vesper::photometry
