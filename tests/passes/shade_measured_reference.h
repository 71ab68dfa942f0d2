// Measured lamps and roads with a table, as the shading takes them. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "photometry/distribution.h"
#include "photometry/reflection_table.h"
#include "photometry/retroreflection.h"

namespace vesper::reference {

using glm::dvec3;

/// A lamp of a measured distribution: right, up and back of its luminaire in the view frame, and the factor on the candela.
struct MeasuredLamp {
    const Distribution* distribution = nullptr;
    glm::dmat3 frame{1};
    double factor = 1;

    double intensity(dvec3 direction) const {
        return factor * vesper::intensity(*distribution, glm::transpose(frame) * direction);
    }
};

/// What the light list and the G-buffer only point to.
struct Measurements {
    std::span<const MeasuredLamp> lamps;      ///< the maps of the light list, in its order
    std::span<const ReflectionTable> roads;   ///< extended()
    std::span<const Retroreflector> sheets;   ///< classes of retroreflection
};

/// L / E of a road on the plane facing the lamp, sr^-1: r / cos^2(gamma) (CIE 144:2001), which beyond the table keeps its
/// last value. beta is drawn to 90 degrees as sight rises from 1.5 to 10 degrees above the road. `beside` is added to the cosine of
/// the angle between light and sight in plan, to see what its rounding does.
inline double road_coefficient(const ReflectionTable& table, dvec3 n, dvec3 l, dvec3 v, double beside = 0) {
    const double cosine = glm::dot(n, l), t = std::min(std::sqrt(1 - cosine * cosine) / cosine, table.tan_gamma.back());
    const dvec3 sight = -(v - n * glm::dot(n, v)), light = l - n * cosine;
    double plan = glm::length(sight) * glm::length(light);
    plan = plan > 0 ? std::clamp(glm::dot(sight, light) / plan + beside, -1.0, 1.0) : 0;
    const double low = std::sin(glm::radians(1.5)), high = std::sin(glm::radians(10.0));
    const double x = std::clamp((glm::dot(n, v) - low) / (high - low), 0.0, 1.0);
    const double beta = std::acos(plan * (1 - x * x * (3 - 2 * x)));
    return reduced_luminance_coefficient(table, t, glm::degrees(beta)) * (1 + t * t);
}

}  // namespace vesper::reference
