// Shares of lamps in a picture's light, and lamps without shadows. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "passes/shade_reference.h"

namespace vesper::reference {

/// The illuminance of each lamp at a point over that of all of them, as if nothing hid them; zeros where there is none.
inline std::vector<double> light_shares(std::span<const shared::Lamp> lamps, const shared::LampCounts& counts,
                                        dvec3 point, dvec3 normal, double threshold) {
    std::vector<double> shares;
    double sum = 0;
    for (uint32_t i = 0; i < lamps.size(); ++i) {
        Shaded of_white;  // of luminance 1 where the illuminance is 1 lx
        shared::Lamp lamp = lamps[i];
        lamp.colour = glm::vec3(1);
        add_lamp(lamp, kind_of(i, counts), point, normal, dvec3(1), {}, 1, threshold, of_white);
        shares.push_back(of_white.luminance.y);
        sum += shares.back();
    }
    for (double& share : shares) share = sum > 0 ? share / sum : 0;
    return shares;
}

/// Of lamps that may be left out, the faintest that together give at most `most`.
inline std::vector<uint32_t> unshadowed(const std::vector<double>& shares, std::vector<uint32_t> optional,
                                        double most) {
    std::ranges::stable_sort(optional, {}, [&](uint32_t lamp) { return shares[lamp]; });
    std::vector<uint32_t> left_out;
    double sum = 0;
    for (const uint32_t lamp : optional)
        if ((sum += shares[lamp]) <= most) left_out.push_back(lamp);
    return left_out;
}

}  // namespace vesper::reference
