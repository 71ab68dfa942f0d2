// Light of the codes of a display. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vision/display.h"

namespace vesper::analysis {

/// Light of a display's pixels as its codes have it, cd/m^2 in linear Rec. 709, three values a pixel: within its gamut,
/// its peak and its steps, with the light that it reflects.
class DisplayLight {
public:
    explicit DisplayLight(const vision::Display&);

    /// Of codes stretched to 0 .. 65535 (io::WideImage): RGBA, alpha ignored.
    std::vector<float> of_wide(std::span<const uint16_t> rgba) const;
    /// Of words of the display's bits a channel, red in the lowest (ToneMapped::display).
    std::vector<float> of_words(std::span<const uint8_t> words) const;

private:
    std::vector<double> light_of(uint32_t largest) const;  // emitted, of each code
    void add(std::vector<float>& pixels, const glm::dvec3& emitted) const;

    vision::Display display_;
    glm::dmat3 to_rec709_;
    double reflected_;  // cd/m^2
};

}  // namespace vesper::analysis
