// What retroreflective surfaces add to shading. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/glm.hpp>

#include "photometry/retroreflection.h"

namespace vesper::reference {

/// Luminance per illuminance facing the lamp, sr^-1, and what rounding directions by `epsilon` may change of it.
struct Returned {
    double value = 0, rounding = 0;
};

/// Of a surface of normal n, lit along l, seen along v (photometry/retroreflection.h); nothing for light from behind.
inline Returned returned(const photometry::Retroreflector& r, glm::dvec3 n, glm::dvec3 l, glm::dvec3 v,
                         double epsilon) {
    const double nl = glm::dot(n, l), nv = glm::dot(n, v), degrees = 180 / std::numbers::pi;
    if (!(nl > 0)) return {};
    const auto angle = [&](double cosine) { return std::acos(std::clamp(cosine, 0.0, 1.0)) * degrees; };
    const auto luminance = [&](double observation, double entrance_cosine, double view_cosine) {
        return photometry::retroreflected_luminance(r, std::max(observation, 0.0), angle(entrance_cosine),
                                                    angle(view_cosine), 1);
    };
    const double observation = 2 * std::asin(std::min(glm::length(l - v) / 2, 1.0)) * degrees;
    const double value = luminance(observation, nl, nv), shift = 2 * epsilon, turn = shift * degrees;
    double moved = 0;
    for (const double sign : {-1.0, 1.0})
        moved += std::abs(luminance(observation + sign * turn, nl, nv) - value) +
                 std::abs(luminance(observation, nl + sign * shift, nv) - value) +
                 std::abs(luminance(observation, nl, nv + sign * shift) - value);
    // 3e-6: logarithms of up to 10 bits. 1e-6: what the device leaves out.
    return {value, moved + 3e-6 * value + 1e-6 / (r.marking ? 1 : std::max(nv, 0.05))};
}

}  // namespace vesper::reference
