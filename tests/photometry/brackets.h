// Photographs of a known scene through a known camera. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "photometry/merge.h"

namespace vesper::test {

/// Numbers that look random, always the same ones.
class CameraNoise {
public:
    double uniform() {
        return static_cast<double>((state_ = state_ * 6364136223846793005u + 1442695040888963407u) >> 11) * 0x1p-53;
    }
    double normal() { return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * std::numbers::pi * uniform()); }

private:
    uint64_t state_ = 1;
};

/// A response and its inverse: display value of an exposure per channel, clipped at 1 afterwards.
struct KnownCamera {
    std::function<double(double, size_t)> value, exposure;
    double noise = 0;  ///< codes, standard deviation

    int code(double x, size_t channel, CameraNoise& random) const {
        const double z = 255 * value(x, channel) + (noise > 0 ? noise * random.normal() : 0);
        return static_cast<int>(std::clamp(std::round(z), 0.0, 255.0));
    }
};

inline KnownCamera gamma_camera(double noise = 0) {
    return {[](double x, size_t) { return std::pow(x, 1 / 2.2); }, [](double v, size_t) { return std::pow(v, 2.2); },
            noise};
}

inline KnownCamera srgb_camera(double noise = 0) {
    return {[](double x, size_t) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; },
            [](double v, size_t) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }, noise};
}

/// S-shaped over ln X, another one per channel, like a film with toe and shoulder; it clips at 97 % of its asymptote.
inline KnownCamera film_camera(double noise = 0) {
    constexpr double kClip = 0.97, kSlope[] = {1.1, 1.25, 0.95}, kMiddle[] = {0.25, 0.2, 0.3};
    return {[=](double x, size_t c) {
                const double p = std::pow(x / kMiddle[c], kSlope[c]);
                return p / (1 + p) / kClip;
            },
            [=](double v, size_t c) { return kMiddle[c] * std::pow(v * kClip / (1 - v * kClip), 1 / kSlope[c]); },
            noise};
}

/// The curve of K. Narkowicz ("ACES filmic tone mapping curve", 2015) before a power of 1/2.2.
inline KnownCamera filmic_camera(double noise = 0) {
    const auto value = [](double x, size_t) {
        x *= 6;
        return std::pow(std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)), 1 / 2.2);
    };
    const auto exposure = [value](double v, size_t c) {
        double low = 0, high = 2;
        for (int i = 0; i < 60; ++i) (value((low + high) / 2, c) < v ? low : high) = (low + high) / 2;
        return high;
    };
    return {value, exposure, noise};
}

/// A night in five decades: a dark gradient, texture, and lamps with soft borders. Largest value near 100.
inline io::HdrImage night(uint32_t width, uint32_t height) {
    io::HdrImage image{width, height};
    CameraNoise random;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            double light = 1e-3 * std::pow(10.0, 2 * u + 0.5 * std::sin(20 * v + 3 * u)) *
                           (1 + 0.2 * std::sin(60 * u) * std::sin(47 * v));
            for (int lamp = 0; lamp < 5; ++lamp) {
                const double d = std::hypot(u - 0.1 - 0.2 * lamp, v - 0.3 - 0.08 * lamp) / 0.09;
                light += 100 * std::exp(-3 * d * d * (1 + d));
            }
            const uint32_t block = (x / 13 * 2654435761u) ^ (y / 9 * 2246822519u);
            light *= (0.3 + 0.2 * ((block >> 13) % 8)) * (1 + 0.02 * random.uniform());
            for (const double tint : {1.2 - 0.3 * v, 1.0, 0.6 + 0.5 * v})
                image.rgb.push_back(static_cast<float>(light * tint));
        }
    return image;
}

/// One photograph of the scene without its outer `margin` px, through a camera that lets in `exposure`. What is at (x,
/// y) comes to (x, y) + shift.
inline photometry::Exposure photograph(const io::HdrImage& scene, const KnownCamera& camera, double exposure,
                                       CameraNoise& random, glm::ivec2 shift = glm::ivec2(0), int margin = 0) {
    photometry::Exposure made;
    made.exposure = exposure;
    const int width = static_cast<int>(scene.width), height = static_cast<int>(scene.height);
    made.image.width = static_cast<uint32_t>(width - 2 * margin);
    made.image.height = static_cast<uint32_t>(height - 2 * margin);
    for (int y = margin; y < height - margin; ++y)
        for (int x = margin; x < width - margin; ++x) {
            const int at_x = std::clamp(x - shift.x, 0, width - 1), at_y = std::clamp(y - shift.y, 0, height - 1);
            const float* p = scene.rgb.data() + 3 * (at_y * width + at_x);
            for (size_t c = 0; c < 3; ++c)
                made.image.rgba.push_back(
                    static_cast<uint8_t>(camera.code(static_cast<double>(p[c]) * exposure, c, random)));
            made.image.rgba.push_back(255);
        }
    return made;
}

/// Exposures `ratio` apart, the first letting in `first`.
inline std::vector<photometry::Exposure> bracket(const io::HdrImage& scene, const KnownCamera& camera, double first,
                                                 double ratio, int count) {
    std::vector<photometry::Exposure> made;
    CameraNoise random;
    for (int i = 0; i < count; ++i) made.push_back(photograph(scene, camera, first * std::pow(ratio, i), random));
    return made;
}

/// The largest difference, relative, of a response from the camera's over a range of codes.
inline double response_error(const photometry::Response& response, const KnownCamera& camera, size_t channel, int from,
                             int to) {
    double worst = 0;
    for (int z = from; z <= to; ++z) {
        const double wanted = camera.exposure(z / 255.0, channel) / camera.exposure(128 / 255.0, channel);
        worst = std::max(worst, std::abs(std::exp(response.ln_exposure[channel][static_cast<size_t>(z)]) / wanted - 1));
    }
    return worst;
}

struct RadianceError {
    double median = 0, p95 = 0, p99 = 0, worst = 0;
    size_t values = 0;
};

/// Relative errors of a merged picture, over values that some exposure holds with a code from 40 to 223 before noise.
/// Its scale is not fitted: a code of 128 is exposure 1.
inline RadianceError radiance_error(const photometry::MergedImage& merged, const io::HdrImage& scene,
                                    const KnownCamera& camera, const std::vector<photometry::Exposure>& exposures) {
    std::vector<double> errors;
    for (size_t i = 0; i < scene.rgb.size(); ++i) {
        const size_t c = i % 3;
        const auto truth = static_cast<double>(scene.rgb[i]);
        const bool held = std::any_of(exposures.begin(), exposures.end(), [&](const photometry::Exposure& e) {
            const double code = 255 * camera.value(truth * e.exposure, c);
            return code >= 40 && code <= 223;
        });
        if (held)
            errors.push_back(
                std::abs(static_cast<double>(merged.image.rgb[i]) * camera.exposure(128 / 255.0, c) / truth - 1));
    }
    std::sort(errors.begin(), errors.end());
    if (errors.empty()) return {};
    return {errors[errors.size() / 2], errors[errors.size() * 95 / 100], errors[errors.size() * 99 / 100],
            errors.back(), errors.size()};
}

}  // namespace vesper::test
