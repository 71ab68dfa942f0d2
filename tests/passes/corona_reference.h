// Needles and halo of the brightest lamps of a picture, in double: squares of light, which of them are lamps, what
// those add. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <glm/glm.hpp>

#include "gpu_scene/view.h"

namespace vesper::reference {

using glm::dvec2, glm::dvec3;

constexpr int kSquareSide = 16;      // px: the light of a square is one lamp
constexpr size_t kMostNeedles = 32;  // lamps that have some
// The pattern reaches this many degrees; its rows are a factor of exp(2 pi / columns) apart. Each has its columns, then
// the means of two, of four, down to one.
constexpr int kColumnsOfPattern = 512, kRowsOfPattern = 448, kDegreesOfPattern = 6;

/// Light from one direction as wide as a box of `width` rad.
struct CoronaLight {
    dvec3 direction{0, 0, -1}, illuminance{0};  // view frame; RGB lx
    double width = 0;                           // a pixel included
};

inline dvec3 corona_ray(const gpu_scene::View& view, dvec2 place) {
    return glm::normalize(dvec3(dvec2(view.ray_scale()) * place + dvec2(view.ray_offset()), -1));
}

/// sr of a pixel seen along a unit vector.
inline double corona_pixel(const gpu_scene::View& view, dvec3 ray) {
    const dvec2 span = glm::abs(dvec2(view.ray_scale()));
    return span.x * span.y * std::pow(-ray.z, 3);
}

/// Of every square that has light, brightest first, kMostNeedles of them, each without the share that the next one has
/// of it.
inline std::vector<CoronaLight> corona_lights(const gpu_scene::View& view, const std::vector<dvec3>& scene) {
    struct Square {
        double luminance;
        int place;
        CoronaLight light;
    };
    std::vector<Square> squares;
    const int width = int(view.extent.width), height = int(view.extent.height), side = kSquareSide;
    for (int top = 0; top < height; top += side)
        for (int left = 0; left < width; left += side) {
            dvec3 light(0);
            double sum = 0, square = 0;
            dvec2 place(0);
            const auto each = [&](auto&& pixel) {
                for (int y = top; y < std::min(top + side, height); ++y)
                    for (int x = left; x < std::min(left + side, width); ++x) {
                        dvec3 rgb = scene[size_t(y) * size_t(width) + size_t(x)];
                        if (!std::isfinite(rgb.r + rgb.g + rgb.b)) continue;
                        rgb = glm::max(rgb, dvec3(0));
                        pixel(rgb, 0.212639 * rgb.r + 0.715169 * rgb.g + 0.072192 * rgb.b, dvec2(x + 0.5, y + 0.5));
                    }
            };
            each([&](dvec3 rgb, double l, dvec2 at) { light += rgb, sum += l, place += l * at; });
            if (!(sum > 0)) continue;
            place /= sum;
            each([&](dvec3, double l, dvec2 at) { square += l * glm::dot(at - place, at - place); });
            const dvec3 ray = corona_ray(view, place);
            const double pixel = corona_pixel(view, ray);
            squares.push_back(
                {sum, int(squares.size()), {ray, pixel * light, std::sqrt(pixel * (1 + 6 * square / sum))}});
        }
    std::stable_sort(squares.begin(), squares.end(),
                     [](const Square& a, const Square& b) { return a.luminance > b.luminance; });
    const double cut = squares.size() > kMostNeedles ? squares[kMostNeedles].luminance : 0;
    std::vector<CoronaLight> lamps;
    for (size_t i = 0; i < std::min(squares.size(), kMostNeedles); ++i) {
        lamps.push_back(squares[i].light);
        lamps.back().illuminance *= 1 - cut / squares[i].luminance;
    }
    return lamps;
}

/// What one lamp adds in a direction, a pixel being as wide as a box of `pixel` rad.
inline dvec3 corona_added(const std::vector<glm::vec4>& pattern, const CoronaLight& lamp, dvec3 ray, double pixel) {
    const int columns = kColumnsOfPattern, rows = kRowsOfPattern, last = 9;
    const double step = 2 * std::numbers::pi / columns;
    const double theta = std::atan2(glm::length(glm::cross(ray, lamp.direction)), glm::dot(ray, lamp.direction));
    const double row = rows + std::log(theta * 180 / std::numbers::pi / kDegreesOfPattern) / step;
    if (!(row > 0 && row < rows)) return dvec3(0);
    const dvec3 right = glm::normalize(dvec3(1, 0, 0) - lamp.direction * lamp.direction.x),
                up = glm::cross(right, lamp.direction);
    double turn = std::atan2(glm::dot(ray, up), glm::dot(ray, right)) / (2 * std::numbers::pi);
    if (turn < 0) turn += 1;
    const auto at_level = [&](int level) {
        size_t first = size_t(row) * (2 * size_t(columns) - 1);
        for (int l = 0; l < level; ++l) first += size_t(columns >> l);
        const int across = columns >> level, left = int(std::floor(turn * across - 0.5));
        const auto at = [&](int i) { return dvec3(pattern[first + size_t((left + i + across) % across)]); };
        return glm::mix(at(0), at(1), turn * across - 0.5 - left);
    };
    const double level =
        std::clamp(std::log2(std::sqrt(pixel * pixel + lamp.width * lamp.width) / (theta * step)), 0.0, double(last));
    const int lower = std::min(int(level), last - 1);
    const double degrees = theta * 180 / std::numbers::pi;
    return lamp.illuminance * glm::mix(at_level(lower), at_level(lower + 1), level - lower) / (degrees * degrees);
}

/// What single precision may do to each pixel: directions and middles of squares are good to 3e-6 rad, where another
/// row of the pattern may be taken; azimuths to 4096 ulp (Vulkan's atan), 1e-3 rad; the light itself to 1e-4, since its
/// level of the pattern is a logarithm.
inline std::vector<double> corona_doubt(const gpu_scene::View& view, const std::vector<dvec3>& scene,
                                        const std::vector<glm::vec4>& pattern) {
    std::vector<double> doubts;
    const std::vector<CoronaLight> lamps = corona_lights(view, scene);
    for (uint32_t y = 0; y < view.extent.height; ++y)
        for (uint32_t x = 0; x < view.extent.width; ++x) {
            const dvec3 ray = corona_ray(view, dvec2(x, y) + 0.5);
            const double pixel = std::sqrt(corona_pixel(view, ray));
            double doubt = 0;
            for (const CoronaLight& light : lamps) {
                const dvec3 here = corona_added(pattern, light, ray, pixel);
                doubt += 1e-4 * glm::length(here);
                // Inwards, outwards, and to both sides.
                for (const double turn : {0.0, 0.25, 0.5, 0.75}) {
                    const dvec3 out = ray - light.direction, side = glm::cross(light.direction, out),
                                size = dvec3(std::max(glm::length(out), 1e-12));
                    const dvec3 step =
                        (std::cos(2 * std::numbers::pi * turn) * out + std::sin(2 * std::numbers::pi * turn) * side) /
                        size;
                    const double far = turn == 0.25 || turn == 0.75 ? 3e-6 + 1e-3 * size.x : 3e-6 + 1e-5 * size.x;
                    doubt += glm::length(corona_added(pattern, light, glm::normalize(ray + far * step), pixel) - here);
                }
            }
            doubts.push_back(doubt);
        }
    return doubts;
}

/// What all of them make of a veil.
inline std::vector<dvec3> corona(const gpu_scene::View& view, const std::vector<dvec3>& scene,
                                 std::vector<dvec3> veiled, const std::vector<glm::vec4>& pattern) {
    const std::vector<CoronaLight> lamps = corona_lights(view, scene);
    for (uint32_t y = 0; y < view.extent.height; ++y)
        for (uint32_t x = 0; x < view.extent.width; ++x) {
            dvec3& pixel = veiled[size_t(y) * view.extent.width + x];
            if (!std::isfinite(pixel.r + pixel.g + pixel.b)) continue;
            const dvec3 ray = corona_ray(view, dvec2(x, y) + 0.5);
            dvec3 sum = pixel;
            for (const CoronaLight& light : lamps)
                sum += corona_added(pattern, light, ray, std::sqrt(corona_pixel(view, ray)));
            pixel = glm::max(sum, glm::min(pixel, dvec3(0)));
        }
    return veiled;
}

}  // namespace vesper::reference
