// The coding of ordinary pictures. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace vesper {

/// Linear value of an sRGB code, both from 0 to 1 (IEC 61966-2-1).
inline double srgb_to_linear(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace vesper
