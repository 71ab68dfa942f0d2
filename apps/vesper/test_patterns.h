// Pictures to look at and to measure on a display. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vesper::commands {

struct PatternSettings {
    uint32_t width = 1920, height = 1080;  ///< px
    uint32_t bits = 8;                     ///< 8 or 10; 10 are written as PNG of 16 bits
    uint32_t patches = 33;                 ///< how many codes to measure
    double window = 0.32;  ///< side of a measured patch as part of the picture's: 0.32 is 10 % of the area
};

/// Writes ramp.png, black.png, near-black.png, near-white.png, patch-CODE.png and measurements.csv, to be filled in, to
/// a folder that exists. Returns the names. Throws Error.
std::vector<std::string> write_test_patterns(const std::string& folder, const PatternSettings&);

}  // namespace vesper::commands
