// Lamps seen directly, pixel by pixel and lamp by lamp. SPDX-License-Identifier: MIT
// Coverage by cutting the silhouette with the pixel's four sides (Sutherland and Hodgman 1974), solid angles in closed
// form.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "gpu_scene/luminaires.h"
#include "gpu_scene/view.h"

namespace vesper::reference {

constexpr double kEdgeDepth =
    0.1;  ///< m: what is nearer than a lamp by so much begins to hide it, by twice as much does

using glm::dvec2, glm::dvec3;

/// Area of a convex polygon within the pixel (x, y) .. (x + 1, y + 1).
inline double area_within(std::vector<dvec2> polygon, double x, double y) {
    for (int side = 0; side < 4; ++side) {
        const auto inside = [&](dvec2 p) {
            return side == 0 ? p.x - x : side == 1 ? x + 1 - p.x : side == 2 ? p.y - y : y + 1 - p.y;
        };
        std::vector<dvec2> kept;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            const double da = inside(a), db = inside(b);
            if (da >= 0) kept.push_back(a);
            if (da * db < 0) kept.push_back(a + (b - a) * (da / (da - db)));
        }
        polygon = kept;
    }
    double twice = 0;
    for (size_t i = 1; i + 1 < polygon.size(); ++i) {
        const dvec2 a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

/// What a surface at `depth` (m; 0: none) lets through of a source.
inline double seen(double depth, double hidden) {
    return depth > 0 ? std::clamp((depth - hidden) / kEdgeDepth, 0.0, 1.0) : 1.0;
}

/// Luminance added to a pixel, cd/m^2, and what single precision may change of it.
struct Added {
    dvec3 luminance{0}, rounding{0};
};

inline Added added(const gpu_scene::LuminaireList& list, uint32_t x, uint32_t y, double depth) {
    Added sum;
    for (const shared::Luminaire& s : list.luminaires) {
        std::vector<dvec2> silhouette;
        dvec2 low(1e30), high(-1e30);
        for (size_t i = 0; i < size_t(s.vertices); ++i) {
            silhouette.push_back(dvec2(s.origin) + dvec2(list.silhouettes[size_t(s.first) + i]));
            low = glm::min(low, silhouette.back()), high = glm::max(high, silhouette.back());
        }
        const double area = area_within(silhouette, x, y), visible = seen(depth, s.hidden);
        sum.luminance += dvec3(s.luminance) * (area * visible);
        // Coordinates of up to some hundred px from the pixel; depths against the edge over which they hide.
        const double hiding = visible > 0 && visible < 1 ? depth * 1.2e-7 / kEdgeDepth : 0;
        const bool near =
            glm::all(glm::greaterThan(high, dvec2(x, y))) && glm::all(glm::lessThan(low, dvec2(x, y) + 1.0));
        if (near) sum.rounding += dvec3(s.luminance) * (2e-6 + area * hiding);
    }
    return sum;
}

/// Solid angle of the rectangle from (0, 0) to (x, y) in the plane of tangents, signed, sr.
inline double corner_solid_angle(double x, double y) { return std::atan(x * y / std::sqrt(1 + x * x + y * y)); }

/// Solid angle of a pixel, sr.
inline double solid_angle(const gpu_scene::View& view, uint32_t x, uint32_t y) {
    const dvec2 scale(view.ray_scale()), offset(view.ray_offset());
    const dvec2 a = scale * dvec2(x, y) + offset, b = scale * dvec2(x + 1, y + 1) + offset;
    return std::abs(corner_solid_angle(b.x, b.y) - corner_solid_angle(a.x, b.y) - corner_solid_angle(b.x, a.y) +
                    corner_solid_angle(a.x, a.y));
}

/// Solid angle of a silhouette, sr: the sum of its triangles (Van Oosterom and Strackee 1983).
inline double solid_angle(const gpu_scene::View& view, std::span<const dvec2> silhouette) {
    const dvec2 scale(view.ray_scale()), offset(view.ray_offset());
    const auto ray = [&](dvec2 p) { return glm::normalize(dvec3(scale * p + offset, -1)); };
    double sum = 0;
    for (size_t i = 1; i + 1 < silhouette.size(); ++i) {
        const dvec3 a = ray(silhouette[0]), b = ray(silhouette[i]), c = ray(silhouette[i + 1]);
        sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)), 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
    }
    return std::abs(sum);
}

/// Illuminance at the eye on a surface that faces every pixel in turn, lx: what the image holds of I / d^2.
template <class Pixel>
double illuminance(const gpu_scene::View& view, const std::vector<Pixel>& pixels) {
    double sum = 0;
    for (uint32_t y = 0; y < view.extent.height; ++y)
        for (uint32_t x = 0; x < view.extent.width; ++x) {
            const dvec3 rgb(pixels[size_t(y) * view.extent.width + x]);
            sum += glm::dot(rgb, dvec3(0.212639, 0.715169, 0.072192)) * solid_angle(view, x, y);
        }
    return sum;
}

}  // namespace vesper::reference
