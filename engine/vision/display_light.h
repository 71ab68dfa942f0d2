// Light of the codes of a display. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vision/display.h"

namespace vesper::vision {

/// Luminance of a display's pixels, cd/m^2, the light that it reflects included.
class DisplayLight {
public:
    explicit DisplayLight(const Display&);

    /// Of codes stretched to 0 .. 65535 (io::WideImage): RGBA, alpha ignored.
    std::vector<float> of_wide(std::span<const uint16_t> rgba) const;
    /// Of words of the display's bits a channel, red in the lowest (ToneMapped::display).
    std::vector<float> of_words(std::span<const uint8_t> words) const;

private:
    std::vector<double> light_of(uint32_t largest) const;  // emitted, of each code

    Display display_;
    glm::dvec3 weights_;  // of each primary's luminance in that of white
};

}  // namespace vesper::vision
