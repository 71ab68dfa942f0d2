// A device through the C interface, whose validation is silent, and pictures for it. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include <vesper/vesper.h>

#include "support/c_device.h"

namespace vesper::test {

class CInterface : public CDevice {};

inline std::vector<float> night_values(uint32_t width, uint32_t height) {
    std::vector<float> rgb;
    for (uint32_t i = 0; i < width * height; ++i) {
        const float l = std::pow(10.0f, -2 + 5 * float(i % 101) / 101);
        rgb.insert(rgb.end(), {l, 0.7f * l, 0.4f * l});
    }
    return rgb;
}

inline VesperPicture picture_of(const std::vector<float>& rgb, uint32_t width, uint32_t height) {
    VesperPicture picture = VESPER_INIT(VesperPicture);
    picture.width = width, picture.height = height, picture.channels = 3, picture.values = rgb.data(),
    picture.scale = 1, picture.vertical_fov = 0.7f;
    return picture;
}

}  // namespace vesper::test
