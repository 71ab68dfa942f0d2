// Codes found in cells against a search through all codes. SPDX-License-Identifier: MIT
#include "eye/encoding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/displays.h"

namespace vesper::test {
namespace {

/// As shared/encode.h says it.
uint32_t code_in_cells(const eye::Encoding& encoding, float light) {
    const auto& [shift, first, last, bits] = encoding.push;
    const glm::vec4& cell = encoding.cells.at(std::clamp(std::bit_cast<uint32_t>(light) >> shift, first, last) - first);
    return uint32_t(light >= cell.r ? cell.b : cell.g);
}

/// Displayed light, relative, from which on each code but 0 is the nearest: that of a code half a step below it. Codes
/// whose half a step is at the display's peak or beyond (PQ) are not needed.
std::vector<double> edges_of(const vision::Display& display) {
    const vision::DisplayCurve curve(display);
    const double black = double(display.black), peak = double(display.peak);
    std::vector<double> edges;
    for (uint32_t code = 1; code <= display.largest_code(); ++code) {
        const double luminance = curve.emitted((code - 0.5) / display.largest_code());
        if (luminance < peak) edges.push_back((luminance - black) / (peak - black));
    }
    return edges;
}

/// Lights over all decades, evenly over [0, 1], and the floats beside every edge.
std::vector<float> lights_about(const std::vector<double>& edges) {
    std::vector<float> lights{0, 1};
    for (int i = 0; i <= 2000; ++i)
        lights.push_back(float(i) / 2000), lights.push_back(std::pow(10.0f, -12 * float(i) / 2000));
    for (const double edge : edges)
        if (edge > 0)
            lights.push_back(std::nextafter(float(edge), 0.0f)), lights.push_back(std::nextafter(float(edge), 1.0f));
    return lights;
}

TEST(Encoding, EveryLightHasItsNearestCode) {
    std::vector<vision::Display> displays = every_kind_of_display();
    displays.push_back({.gamma = 1, .bits = 10});
    displays.push_back({.gamma = 3.4f, .bits = 10});
    displays.push_back({.peak = 48, .black = 0.001f, .eotf = vision::Eotf::Srgb, .bits = 10});
    displays.push_back({.peak = 100, .black = 0, .eotf = vision::Eotf::Pq});
    displays.push_back({.peak = 10000, .black = 0, .eotf = vision::Eotf::Pq, .bits = 10});
    for (const vision::Display& display : displays) {
        SCOPED_TRACE("transfer function " + std::to_string(int(display.eotf)) + ", " + std::to_string(display.bits) +
                     " bits, peak " + std::to_string(display.peak));
        const eye::Encoding encoding = eye::make_encoding(display);
        EXPECT_EQ(encoding.push.bits, display.bits);
        const std::vector<double> edges = edges_of(display);
        size_t wrong = 0;
        for (const float light : lights_about(edges)) {
            const auto want =
                std::count_if(edges.begin(), edges.end(), [&](double edge) { return edge <= double(light); });
            if (code_in_cells(encoding, light) != uint32_t(want)) ++wrong;
        }
        EXPECT_EQ(wrong, 0u);
    }
}

}  // namespace
}  // namespace vesper::test
