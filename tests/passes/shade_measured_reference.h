// Measured lamps and roads with a table, as the shading takes them. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "gpu_scene/intensity_tables.h"
#include "photometry/distribution.h"
#include "photometry/reflection_table.h"
#include "photometry/retroreflection.h"

namespace vesper::reference {

using glm::dvec3;

/// A lamp of a measured distribution: right, up and back of its luminaire in the view frame, and the factor on the
/// candela.
struct MeasuredLamp {
    const photometry::Distribution* distribution = nullptr;
    glm::dmat3 frame{1};
    double factor = 1;

    double intensity(dvec3 direction) const {
        return factor * photometry::intensity(*distribution, glm::transpose(frame) * direction);
    }
};

/// A road with a table, extended().
struct RoadSurface {
    explicit RoadSurface(photometry::ReflectionTable of)
        : table(std::move(of)), diffuse(gpu_scene::reflectance_in_diffuse(table) / std::numbers::pi) {}
    photometry::ReflectionTable table;
    double diffuse;  ///< Qd as maps are relative to it, sr^-1
};

/// What the list of lamps and the G-buffer only point to.
struct Measurements {
    std::span<const MeasuredLamp> lamps;  ///< measured lamps of the list, in its order
    std::span<const RoadSurface> roads;
    std::span<const photometry::Retroreflector> sheets;  ///< classes of retroreflection
};

/// How much of a road's sheen is seen under a sight whose sine with the road is given: all to 1.5 degrees, none
/// from 10.
inline double sheen_seen(double sine) {
    const double low = std::sin(glm::radians(1.5)), high = std::sin(glm::radians(10.0));
    const double x = std::clamp((sine - low) / (high - low), 0.0, 1.0);
    return 1 - x * x * (3 - 2 * x);
}

/// What a road reflects of light from all sides, over what it does seen at 1 degree; `plain`: without sheen.
inline double road_in_diffuse(double plain, double sine) { return plain + (1 - plain) * sheen_seen(sine); }

/// L / E of a road on the plane facing the lamp, sr^-1: r / cos^2(gamma) (CIE 144:2001), which beyond the table keeps
/// its last value. What it has beyond that at beta 90 degrees is sheen. `beside` is added to the cosine of the angle
/// between light and sight in plan, to see what its rounding does.
inline double road_coefficient(const photometry::ReflectionTable& table, dvec3 n, dvec3 l, dvec3 v, double beside = 0) {
    const double cosine = glm::dot(n, l), t = std::min(std::sqrt(1 - cosine * cosine) / cosine, table.tan_gamma.back());
    const dvec3 sight = -(v - n * glm::dot(n, v)), light = l - n * cosine;
    double plan = glm::length(sight) * glm::length(light);
    plan = plan > 0 ? std::clamp(glm::dot(sight, light) / plan + beside, -1.0, 1.0) : 0;
    const double plain = photometry::reduced_luminance_coefficient(table, t, 90),
                 shown = photometry::reduced_luminance_coefficient(table, t, glm::degrees(std::acos(plan)));
    return (plain + (shown - plain) * sheen_seen(glm::dot(n, v))) * (1 + t * t);
}

}  // namespace vesper::reference
