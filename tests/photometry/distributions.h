// Making distributions and photometric files for tests. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "photometry/distribution.h"
#include "support/complaints.h"

namespace vesper::test {

inline std::span<const uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

/// Text of ASCII and Latin-1 as UTF-16 with a byte order mark.
inline std::string utf16_of(const std::string& text, bool big_endian) {
    std::string made;
    const auto put = [&](uint8_t high, uint8_t low) {
        made += static_cast<char>(big_endian ? high : low);
        made += static_cast<char>(big_endian ? low : high);
    };
    put(0xfe, 0xff);
    for (const char c : text) put(0, static_cast<uint8_t>(c));
    return made;
}

/// Angles from first to last.
inline std::vector<double> steps(double first, double last, double step) {
    std::vector<double> angles;
    for (int i = 0; first + i * step <= last + 1e-9; ++i) angles.push_back(first + i * step);
    return angles;
}

inline photometry::Distribution tabulate(photometry::Goniometry goniometry, std::vector<double> horizontal,
                                         std::vector<double> vertical,
                                         const std::function<double(double, double)>& candela) {
    photometry::Distribution made;
    made.name = "made";
    made.goniometry = goniometry;
    made.horizontal = std::move(horizontal);
    made.vertical = std::move(vertical);
    for (const double h : made.horizontal)
        for (const double v : made.vertical) made.candela.push_back(candela(h, v));
    return made;
}

/// The direction of C and gamma in the luminaire's frame.
inline glm::dvec3 c_gamma(double c, double gamma) {
    return {std::sin(gamma * kRadiansPerDegree) * std::cos(c * kRadiansPerDegree),
            std::sin(gamma * kRadiansPerDegree) * std::sin(c * kRadiansPerDegree),
            -std::cos(gamma * kRadiansPerDegree)};
}

/// Right, up and forward of a headlamp, in the luminaire's frame.
inline glm::dvec3 type_a(double h, double v) {
    return {std::cos(v * kRadiansPerDegree) * std::sin(h * kRadiansPerDegree), std::sin(v * kRadiansPerDegree),
            -std::cos(v * kRadiansPerDegree) * std::cos(h * kRadiansPerDegree)};
}
inline glm::dvec3 type_b(double h, double v) {
    return {std::sin(h * kRadiansPerDegree), std::cos(h * kRadiansPerDegree) * std::sin(v * kRadiansPerDegree),
            -std::cos(h * kRadiansPerDegree) * std::cos(v * kRadiansPerDegree)};
}

inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
    const size_t at = text.find(what);
    EXPECT_NE(at, text.npos) << what;
    return at == text.npos ? text : text.replace(at, what.size(), with);
}

}  // namespace vesper::test
