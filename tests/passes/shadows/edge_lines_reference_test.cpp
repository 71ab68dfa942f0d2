// Lines in place of stairs: straight edges, corners, and what turns and mirrors keep. SPDX-License-Identifier: MIT
#include "passes/shadows/edge_lines_reference.h"

#include <random>

#include <gtest/gtest.h>

namespace vesper::test::edge_lines_reference_test {
namespace {

template <class Lit>
reference::TexelWindow window_of(const Lit& lit) {
    reference::TexelWindow window{};
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) window[size_t(y)][size_t(x)] = lit(x, y);
    return window;
}

double share(const reference::TexelWindow& window, glm::dvec2 at, double pixel = 0.05) {
    return reference::line_share(window, at, {pixel, 0}, {0, pixel});
}

// Where the lit half of a column of the window ends.
double height(const reference::TexelWindow& window, double x) {
    double sum = 0, step = 1.0 / 256;
    for (double y = 4; y < 11; y += step) sum += share(window, {x, y + step / 2}) * step;
    return 4 + sum;
}

// Lit below a line that rises by a texel every n: the edge is a straight line of that slope, half a step off at most.
TEST(EdgeLinesReference, StraightEdgesAreStraight) {
    for (const int n : {1, 2, 3, 4, 5, 6})
        for (const double begin : {6.9, 7.15, 7.42}) {
            const auto line = [&](double x) { return begin + (x - 7.3) / n; };
            const reference::TexelWindow window = window_of([&](int x, int y) { return y < line(x); });
            double least = 1, most = -1;
            for (double x = 6.1; x < 9; x += 0.23) {
                const double off = height(window, x) - line(x);
                least = std::min(least, off), most = std::max(most, off);
            }
            EXPECT_LT(most - least, 0.01) << n;
            EXPECT_LE(std::max(most, -least), 0.5 / n + 0.01) << n;
        }
}

// A run that is longer than the window shows: still no step, and at most half a texel off.
TEST(EdgeLinesReference, EdgesThatHardlyRiseHaveNoStep) {
    const auto line = [](double x) { return 7.5 + (x - 7.5) / 40; };
    const reference::TexelWindow window = window_of([&](int x, int y) { return y < line(x); });
    double before = height(window, 4);
    for (double x = 4.1; x < 11; x += 0.1) {
        const double here = height(window, x);
        EXPECT_NEAR(here, line(x), 0.51);
        EXPECT_NEAR(here, before, 0.03) << x;
        before = here;
    }
}

TEST(EdgeLinesReference, WhatIsFarFromEdgesIsItself) {
    const reference::TexelWindow window = window_of([](int x, int) { return x > 7; });
    EXPECT_EQ(share(window, {5.2, 8}), 0);
    EXPECT_EQ(share(window, {9.7, 8}), 1);
    EXPECT_NEAR(share(window, {7.5, 8}), 0.5, 1e-7);
    EXPECT_NEAR(share(window, {7.51, 8}), 0.7, 1e-7) << "0.01 texel of a pixel of 0.05";
    EXPECT_NEAR(share(window, {7.51, 8}, 0.5), 0.52, 1e-7);
    EXPECT_NEAR(share(window, {7.6, 8}, 7), 0.6, 1e-7) << "an edge is as wide as a texel at most";
}

// Turned and mirrored by the borders of texels, and with light for dark, an edge is the same.
TEST(EdgeLinesReference, TurnsAndMirrorsChangeNothing) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int k = 0; k < 200; ++k) {
        const glm::dvec2 slope(unit(random) - 0.5, unit(random) - 0.5),
            at = 5.0 + 5.0 * glm::dvec2(unit(random), unit(random));
        const auto lit = [&](int x, int y) {
            return std::sin(slope.x * x) + std::sin(slope.y * y) > 0.3 * std::sin(0.8 * x * y);
        };
        const double plain = share(window_of(lit), at);
        EXPECT_NEAR(share(window_of([&](int x, int y) { return lit(15 - x, y); }), {15 - at.x, at.y}), plain, 1e-7);
        EXPECT_NEAR(share(window_of([&](int x, int y) { return lit(x, 15 - y); }), {at.x, 15 - at.y}), plain, 1e-7);
        EXPECT_NEAR(share(window_of([&](int x, int y) { return !lit(x, y); }), at), 1 - plain, 1e-7);
    }
}

}  // namespace
}  // namespace vesper::test::edge_lines_reference_test
