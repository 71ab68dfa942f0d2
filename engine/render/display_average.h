// The mean of what a display shows. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vision/display.h"

namespace vesper::render {

/// Averages pictures of display codes as light: what an eye sees that cannot tell the pixels of a finer display apart.
class DisplayAverage {
public:
    /// Throws Error if there is no room for so many pixels.
    DisplayAverage(const vision::Display& display, size_t pixels);

    /// Adds a picture, 4 bytes a pixel, as ToneMapped::display has it.
    void add(std::span<const uint8_t> codes);
    /// Of the pictures that were added, at least one: the codes nearest to the mean of each channel's luminance.
    std::vector<uint8_t> codes() const;

private:
    uint32_t code_of(double luminance) const;

    uint32_t bits_;
    std::vector<double> luminance_;  // of each code, cd/m^2
    std::vector<double> borders_;    // between each code and the next
    std::vector<double> sums_;       // three a pixel
    uint32_t pictures_ = 0;
};

}  // namespace vesper::render
