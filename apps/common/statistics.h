// Luminance statistics of a rendered frame. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vesper::apps {

/// Statistics of the finite pixels, cd/m^2.
struct LuminanceStatistics {
    double minimum = 0, maximum = 0, mean = 0, log_mean = 0;  ///< log_mean: exp(mean ln max(L, 1e-4))
    std::vector<std::pair<double, double>> percentiles;       ///< percent, luminance
    uint64_t finite = 0, non_finite = 0;                      ///< pixels
    double least_positive = 0;                                ///< 0: none is
    uint64_t zero = 0, negative = 0;                          ///< pixels
};

/// Of pixels in cd/m^2 RGB, of 4 (RGBA) or 3 values each.
LuminanceStatistics luminance_statistics(std::span<const float> pixels, size_t channels = 4);

/// Whether a pixel of this luminance holds no light that an eye could see: not finite, or negative.
bool is_damaged(double luminance);
/// "FILE: N pixels are not finite or of negative luminance: TAKEN".
std::string damaged_text(const std::string& file, uint64_t pixels, const std::string& taken);

/// As a table for a terminal, under a heading that says what the numbers are.
std::string text_of(const LuminanceStatistics& statistics, const std::string& heading);
/// As a JSON object.
std::string json_of(const LuminanceStatistics& statistics);

}  // namespace vesper::apps
