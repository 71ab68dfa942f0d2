// Light from everywhere and tunnels, one pixel after another, in double. SPDX-License-Identifier: MIT
// In the open E rho lambert. Inside a tunnel the two ends are rectangles of luminance E / pi: the form factor of a
// polygon is F = |sum theta_i (n . (v_i x v_i+1)^)| / (2 pi) over its edges (Lambert 1760; Baum, Rushmeier and Winget
// 1989, Eq. 6), after clipping to the horizon (Sutherland and Hodgman 1974).
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "gpu_scene/view.h"
#include "passes/shade_reference.h"
#include "scene/tunnel.h"
#include "shared/daylight.h"

namespace vesper::reference {

inline std::vector<dvec3> above_horizon(const std::vector<dvec3>& polygon, dvec3 n) {
    std::vector<dvec3> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(n, a), db = glm::dot(n, b);
        if (da >= 0) kept.push_back(a);
        if ((da < 0) != (db < 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    return kept;
}

/// Of a polygon as a surface element at the origin with normal `n` sees it.
inline double polygon_form_factor(const std::vector<dvec3>& polygon, dvec3 n) {
    const std::vector<dvec3> seen = above_horizon(polygon, n);
    double sum = 0;
    for (size_t i = 0; i < seen.size(); ++i) {
        const dvec3 a = seen[i], b = seen[(i + 1) % seen.size()], across = glm::cross(a, b);
        const double sine = glm::length(across);
        if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(n, across) / sine;
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

/// Part of the light in the open that a surface gets; world.
inline double daylight_part(const std::vector<scene::Tunnel>& tunnels, dvec3 position, dvec3 n) {
    double part = 1;
    for (const scene::Tunnel& t : tunnels) {
        const dvec3 from(t.from), to(t.to), along = glm::normalize(to - from);
        const dvec3 up = glm::normalize(dvec3(0, 1, 0) - along.y * along), across = glm::cross(along, up);
        const dvec3 there = position - from;
        const double ahead = glm::dot(there, along), above = glm::dot(there, up), half = double(t.width) / 2,
                     wall = 0.2;
        if (!(ahead > 0 && ahead < glm::length(to - from) && std::abs(glm::dot(there, across)) < half + wall &&
              above > -wall && above < double(t.height) + wall))
            continue;
        part = 0;
        for (const dvec3 end : {from, to}) {
            const dvec3 low = end - position, high = low + double(t.height) * up;
            part += polygon_form_factor(
                {low - half * across, low + half * across, high + half * across, high - half * across}, n);
        }
    }
    return part;
}

/// One pixel of a view; `luminance` is what it had.
inline dvec3 add_daylight(const std::vector<scene::Tunnel>& tunnels, const SurfaceTexel& texel, dvec3 luminance,
                          glm::dvec2 pixel_centre, const gpu_scene::View& view, dvec3 illuminance, double lambert,
                          dvec3 moved = dvec3(0)) {
    const double depth = texel.surface.z;
    if (!(depth > 0)) return luminance;
    const glm::dmat4 world = glm::inverse(glm::dmat4(view.world_to_view));
    const dvec3 at = depth * dvec3(glm::dvec2(view.ray_scale()) * pixel_centre + glm::dvec2(view.ray_offset()), -1);
    const double part = daylight_part(tunnels, dvec3(world * glm::dvec4(at, 1)) + moved,
                                      glm::dmat3(world) * octahedral_decode(dvec2(texel.surface)));
    const dvec3 n = octahedral_decode(dvec2(texel.surface));
    const double kept = texel.reflectance.w <= double(shared::kRoadKind)
                            ? road_in_diffuse(-texel.surface.w, -glm::dot(n, glm::normalize(at)))
                            : 1;
    return luminance + illuminance * dvec3(texel.reflectance) * (lambert * part * kept);
}

}  // namespace vesper::reference
