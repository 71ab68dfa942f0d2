// Lines in place of stairs of texels at edges of shadows. SPDX-License-Identifier: MIT
// After morphological antialiasing (Reshetov 2009) of a window of 16 x 16 texels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <glm/glm.hpp>

namespace vesper::reference {

/// Whether texels see the lamp, by rows.
using TexelWindow = std::array<std::array<bool, 16>, 16>;

/// The height of the line along a run of texels, over the border between their two rows; and the length of the run, 0
/// where the rows do not differ.
struct RunLine {
    double height = 0;  ///< texels
    int length = 0;     ///< texels
};

/// `sees(k, s)`: the k-th texel of the first or the second row. `at`: 0 to 15, the middle of texel i at i.
template <class Sees>
RunLine run_line(const Sees& sees, double at, int i) {
    const auto edge = [&](int k) { return sees(k, 0) != sees(k, 1); };
    if (!edge(i)) return {};
    int begin = i, end = i;
    while (begin > 0 && edge(begin - 1) && sees(begin - 1, 0) == sees(i, 0)) --begin;
    while (end < 15 && edge(end + 1) && sees(end + 1, 0) == sees(i, 0)) ++end;
    // Half a texel up where both texels beyond the end are as the first row's here.
    const auto step = [&](int k) {
        if (k < 0 || k > 15 || edge(k)) return 0.0;
        return sees(k, 0) == sees(i, 0) ? 0.5 : -0.5;
    };
    const int length = end - begin + 1;
    const double margin = std::min(at, 15 - at), reach = std::max(std::min<double>(length, margin) / 2, 0.5);
    const auto part = [&](double distance) { return std::max(0.0, 1 - distance / reach); };
    return {step(begin - 1) * part(at - (begin - 0.5)) + step(end + 1) * part(end + 0.5 - at), length};
}

/// The share of a pixel that is lit. `at`: its middle in the window, 1 to 14, texel (x, y) has its middle at (x, y).
/// `right`, `down`: how that changes with a step of a pixel.
inline double line_share(const TexelWindow& window, glm::dvec2 at, glm::dvec2 right, glm::dvec2 down) {
    const glm::ivec2 corner(glm::floor(at)), nearest(glm::floor(at + 0.5));
    const auto rows = [&](int k, int s) { return window[size_t(corner.y + s)][size_t(k)]; };
    const auto columns = [&](int k, int s) { return window[size_t(k)][size_t(corner.x + s)]; };
    const RunLine level = run_line(rows, at.x, nearest.x), upright = run_line(columns, at.y, nearest.y);
    if (level.length == 0 && upright.length == 0) return window[size_t(nearest.y)][size_t(nearest.x)] ? 1 : 0;
    const bool lies = level.length >= upright.length;
    const auto beyond = [&](glm::dvec2 place) {  // the line, to the second row or column, texels
        return lies ? place.y - corner.y - 0.5 - run_line(rows, place.x, nearest.x).height
                    : place.x - corner.x - 0.5 - run_line(columns, place.y, nearest.y).height;
    };
    constexpr double kStep = 1e-6;
    const double change =
        std::hypot(beyond(at + kStep * right) - beyond(at), beyond(at + kStep * down) - beyond(at)) / kStep;
    const bool lit = lies ? rows(nearest.x, 1) : columns(nearest.y, 1);
    return std::clamp(0.5 + (lit ? 1 : -1) * beyond(at) / std::clamp(change, 1e-3, 1.0), 0.0, 1.0);
}

}  // namespace vesper::reference
