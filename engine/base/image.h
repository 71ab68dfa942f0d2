// A picture of 8 bits per channel. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vesper {

/// A picture as in its file: RGBA with 8 bits per channel, rows from the top, not linear.
struct Image {
    std::string name;
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;  ///< width * height * 4 codes
};

}  // namespace vesper
