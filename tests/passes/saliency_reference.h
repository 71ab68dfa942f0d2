// Saliency in double, straight from its definition. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <numbers>

#include "passes/pyramid_reference.h"

namespace vesper::reference {

/// One value per texel.
struct SaliencyMap {
    int width = 0, height = 0;
    std::vector<double> values;

    SaliencyMap() = default;
    SaliencyMap(int w, int h) : width(w), height(h), values(size_t(w) * size_t(h)) {}
    double& at(int x, int y) { return values[size_t(y) * size_t(width) + size_t(x)]; }
    double at(int x, int y) const { return values[size_t(y) * size_t(width) + size_t(x)]; }
    double greatest() const { return *std::max_element(values.begin(), values.end()); }
};

inline void add(SaliencyMap& to, const SaliencyMap& map, double factor = 1) {
    for (size_t i = 0; i < to.values.size(); ++i) to.values[i] += factor * map.values[i];
}

/// A level: luminance (cd/m^2), two opponencies, contrasts at 0, 45, 90 and 135 degrees; how many pixels are finite.
struct SaliencyLevel {
    std::array<SaliencyMap, 3> plain;
    std::array<SaliencyMap, 4> oriented;
    SaliencyMap pixels;
};

/// Differences of the mean colour over its largest channel (Walther and Koch 2006), with what cones see nothing below.
inline dvec2 opponency(dvec3 rgb) {
    const double over = 1 / (std::max({rgb.x, rgb.y, rgb.z}) + 0.00562);
    return {over * (rgb.x - rgb.y), over * (rgb.z - std::min(rgb.x, rgb.y))};
}

/// The texel that stands for one up to 4 beyond an edge: its mirror image, or the last one of what is too small for
/// that.
inline int mirrored(int at, int size) {
    const int inside = at < 0 ? -1 - at : at >= size ? 2 * size - 1 - at : at;
    return std::clamp(inside, 0, size - 1);
}

/// The energy in a Gabor filter of period 7 and deviation 7/3 over 9 x 9 texels, which answers nothing to even light,
/// over the mean under its Gaussian (Peli 1990).
inline double oriented_contrast(const SaliencyMap& light, const SaliencyMap& pixels, int x, int y, double degrees) {
    const double angle = degrees * std::numbers::pi / 180, turn = 2 * std::numbers::pi / 7;
    double sum = 0, cosines = 0, even = 0, odd = 0, mean = 0;
    const auto gauss = [](int i, int j) { return std::exp(-(i * i + j * j) / (2 * 49 / 9.0)); };
    const auto phase = [&](int i, int j) { return turn * (i * std::cos(angle) + j * std::sin(angle)); };
    for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i) sum += gauss(i, j), cosines += gauss(i, j) * std::cos(phase(i, j));
    for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i) {
            const int u = mirrored(x + i, light.width), v = mirrored(y + j, light.height);
            if (!(pixels.at(u, v) > 0)) continue;  // as bright as the texel itself
            const double difference = light.at(u, v) - light.at(x, y);
            even += gauss(i, j) * (std::cos(phase(i, j)) - cosines / sum) * difference;
            odd += gauss(i, j) * std::sin(phase(i, j)) * difference;
            mean += gauss(i, j) / sum * difference;
        }
    return pixels.at(x, y) > 0 ? std::hypot(even, odd) / sum / (light.at(x, y) + mean + 1.38e-3) : 0;
}

/// Texels of 2^level px, from 4 on.
template <class Rgb>
SaliencyLevel saliency_level(std::span<const Rgb> image, int width, int height, int level) {
    const auto texels = [](int size, int side) { return (size + side - 1) / side; };
    const int side = 1 << level, finest = 4;
    SaliencyLevel made;
    made.pixels = SaliencyMap(texels(width, side), texels(height, side));
    made.plain.fill(made.pixels), made.oriented.fill(made.pixels);
    for (int y = 0; y < texels(height, finest); ++y)
        for (int x = 0; x < texels(width, finest); ++x) {
            dvec3 mean(0);
            double count = 0;
            for (int v = finest * y; v < std::min(finest * (y + 1), height); ++v)
                for (int u = finest * x; u < std::min(finest * (x + 1), width); ++u) {
                    const auto& p = image[size_t(v) * size_t(width) + size_t(u)];
                    const dvec3 rgb(p.x, p.y, p.z);
                    if (!finite(rgb)) continue;
                    mean += glm::clamp(rgb, 0.0, 1e12), count += 1;
                }
            if (count == 0) continue;
            mean /= count;
            const int i = x * finest / side, j = y * finest / side;
            const dvec2 opponent = opponency(mean);
            made.plain[0].at(i, j) += count * luminance(mean);
            made.plain[1].at(i, j) += count * opponent.x, made.plain[2].at(i, j) += count * opponent.y;
            made.pixels.at(i, j) += count;
        }
    for (SaliencyMap& map : made.plain)
        for (size_t i = 0; i < map.values.size(); ++i) map.values[i] /= std::max(made.pixels.values[i], 1.0);
    for (size_t k = 0; k < 4; ++k)
        for (int y = 0; y < made.pixels.height; ++y)
            for (int x = 0; x < made.pixels.width; ++x)
                made.oriented[k].at(x, y) = oriented_contrast(made.plain[0], made.pixels, x, y, 45.0 * double(k));
    return made;
}

/// A value of a level at a place of one `times` as fine, linear between the middles of texels that have finite pixels;
/// the sum of their weights goes to `weights`.
inline double surround_at(const SaliencyMap& map, const SaliencyMap& pixels, int x, int y, int times, double& weights) {
    const double u = std::clamp((x + 0.5) / times - 0.5, 0.0, map.width - 1.0),
                 v = std::clamp((y + 0.5) / times - 0.5, 0.0, map.height - 1.0);
    double sum = 0;
    weights = 0;
    for (int j = 0; j < map.height; ++j)
        for (int i = 0; i < map.width; ++i) {
            const double weight = std::max(1 - std::abs(u - i), 0.0) * std::max(1 - std::abs(v - j), 0.0);
            if (weight > 0 && pixels.at(i, j) > 0) sum += weight * map.at(i, j), weights += weight;
        }
    return weights > 0 ? sum / weights : 0;
}

/// How a value is compared with that of its surround.
using Compare = double (*)(double own, double about);
inline double relative(double own, double about) { return std::abs(own - about) / (about + 1.38e-3); }
inline double apart(double own, double about) { return std::abs(own - about); }
inline double more(double own, double about) { return std::max(own - about, 0.0); }
inline double less(double own, double about) { return std::max(about - own, 0.0); }

/// Differences between a map of a level and the same of its surround, `times` as coarse; means of block x block texels.
inline SaliencyMap contrast(const SaliencyMap& centre, const SaliencyMap& surround, const SaliencyLevel& of,
                            const SaliencyLevel& about, Compare compare, int block, int times) {
    const auto blocks = [block](int size) { return (size + block - 1) / block; };
    SaliencyMap made(blocks(centre.width), blocks(centre.height)), counts = made;
    for (int y = 0; y < centre.height; ++y)
        for (int x = 0; x < centre.width; ++x) {
            double weights;
            const double outside = surround_at(surround, about.pixels, x, y, times, weights);
            if (!(of.pixels.at(x, y) > 0) || !(weights > 0)) continue;
            made.at(x / block, y / block) += compare(centre.at(x, y), outside);
            counts.at(x / block, y / block) += 1;
        }
    for (size_t i = 0; i < made.values.size(); ++i) made.values[i] /= std::max(counts.values[i], 1.0);
    return made;
}

/// The operator N of Itti, Koch and Niebur 1998.
inline SaliencyMap promoted(const SaliencyMap& map) {
    const double most = map.greatest();
    double sum = 0, count = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const double own = map.at(x, y);
            bool peak = own > 0 && own >= 0.1 * most;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, map.height - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, map.width - 1); ++u) {
                    const bool before = v < y || (v == y && u < x);
                    peak = peak && (before ? own > map.at(u, v) : own >= map.at(u, v));
                }
            if (peak) sum += own, count += 1;
        }
    const double others = count > 1 ? (sum - most) / (count - 1) : 0, full = std::max(most, 0.01);
    SaliencyMap made = map;
    for (double& value : made.values) value *= std::pow((most - others) / full, 2) / full;
    return made;
}

/// Saliency and the conspicuities of intensity, colour and orientation.
template <class Rgb>
std::array<SaliencyMap, 4> saliency(std::span<const Rgb> image, int width, int height) {
    const auto texels = [](int size) { return (size + 15) / 16; };
    const SaliencyMap empty(texels(width), texels(height));
    std::vector<SaliencyLevel> levels(9);
    for (int k = 2; k <= 8; ++k)
        if (std::min(width, height) >= 1 << k) levels[size_t(k)] = saliency_level(image, width, height, k);
    SaliencyMap intensity = empty, colour = empty, orientation = empty;
    std::array<SaliencyMap, 4> oriented{empty, empty, empty, empty};
    for (int c = 2; c <= 4; ++c)
        for (int s = c + 3; s <= c + 4; ++s) {
            if (std::min(width, height) < 1 << s) continue;
            const SaliencyLevel &of = levels[size_t(c)], &about = levels[size_t(s)];
            const auto map = [&](const SaliencyMap& centre, const SaliencyMap& surround, Compare compare) {
                return promoted(contrast(centre, surround, of, about, compare, 16 >> c, 1 << (s - c)));
            };
            add(intensity, map(of.plain[0], about.plain[0], relative));
            for (size_t k = 1; k < 3; ++k)
                add(colour, map(of.plain[k], about.plain[k], more)),
                    add(colour, map(of.plain[k], about.plain[k], less));
            for (size_t k = 0; k < 4; ++k) add(oriented[k], map(of.oriented[k], about.oriented[k], apart));
        }
    for (const SaliencyMap& map : oriented) add(orientation, promoted(map));
    std::array<SaliencyMap, 4> made{empty, promoted(intensity), promoted(colour), promoted(orientation)};
    for (size_t k = 1; k < 4; ++k) add(made[0], made[k], 1 / 3.0);
    return made;
}

}  // namespace vesper::reference
