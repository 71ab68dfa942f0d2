// Displays of every kind to test with. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vision/display.h"

namespace vesper::test {

/// A display measured at uneven codes, of an odd shape.
inline vision::Display measured_display(uint32_t bits = 8) {
    return {.peak = 90,
            .black = 0.3f,
            .ambient = 20,
            .eotf = vision::Eotf::Table,
            .bits = bits,
            .table = {{0, 0.3f}, {0.02, 0.305}, {0.1, 0.5}, {0.3, 5}, {0.31, 8}, {0.6, 30}, {0.9, 80}, {1, 90}}};
}

/// That one with 8 and 10 bits, and all that are known by name.
inline std::vector<vision::Display> every_kind_of_display() {
    std::vector<vision::Display> displays{measured_display(), measured_display(10)};
    for (const vision::NamedDisplay& known : vision::known_displays()) displays.push_back(known.display);
    return displays;
}

}  // namespace vesper::test
