// Small emitters, pixel by pixel and triangle by triangle, in double. SPDX-License-Identifier: MIT
#pragma once

#include "gpu_scene/small_emitters.h"
#include "passes/edges_reference.h"
#include "passes/luminaires_reference.h"
#include "shared/small_emitter.h"

namespace vesper::reference {

/// A triangle of the list in the image.
struct SmallTriangle {
    std::vector<dvec2> silhouette;  ///< px
    dvec3 luminance, inverse_depth;
    dvec2 origin;
    double widening = 1, placement = 0, reach = 0;  ///< as of shared::SmallEmitter

    /// How far inside a place is, px; negative: outside.
    double inside(dvec2 place) const {
        double least = std::numeric_limits<double>::infinity();
        for (size_t i = 0; i < silhouette.size(); ++i) {
            const dvec2 a = silhouette[i], along = silhouette[(i + 1) % silhouette.size()] - a, way = place - a;
            least = std::min(least, (along.x * way.y - along.y * way.x) / glm::length(along));
        }
        return least;
    }
    double depth(dvec2 place) const { return glm::dot(inverse_depth, dvec3(place - origin, 1)); }  // 1/m
};

inline std::vector<SmallTriangle> triangles_of(const gpu_scene::SmallEmitterList& list) {
    std::vector<SmallTriangle> triangles;
    for (const shared::SmallEmitter& e : list.emitters) {
        SmallTriangle triangle{{},
                               dvec3(e.luminance),
                               dvec3(e.inverse_depth),
                               dvec2(e.origin),
                               double(e.widening),
                               double(e.placement),
                               double(e.reach)};
        for (size_t i = 0; i < size_t(e.vertices); ++i)
            triangle.silhouette.push_back(triangle.origin + dvec2(list.silhouettes[size_t(e.first) + i]));
        triangles.push_back(triangle);
    }
    return triangles;
}

struct Emitted {
    dvec3 luminance{0};                                      ///< cd/m^2
    double doubt = std::numeric_limits<double>::infinity();  ///< px: how near some point was to another answer
};

/// What the pixel gets of them.
inline Emitted emitted(const std::vector<SmallTriangle>& triangles, const SeenPicture& picture, ivec2 p) {
    Emitted sum;
    std::array<dvec2, kPixelPoints> places;
    std::array<double, kPixelPoints> nearest{};  // 1/m
    for (uint32_t i = 0; i < kPixelPoints; ++i) {
        const uint32_t reversed = (i & 1) << 3 | (i & 2) << 1 | (i & 4) >> 1 | (i & 8) >> 3;
        places[i] = dvec2(p) + dvec2((i + 0.5) / 16, reversed / 16.0 + 1 / 32.0);
    }
    double filling = 0, filling_placement = 0;
    for (const ivec2 q : neighbourhood(p)) {
        if (!picture.has(q) || picture.facet(q).instance == 0) continue;
        const SeenFacet& facet = picture.facet(q);
        const dvec3 middle(picture.scale * (dvec2(q) + 0.5) + picture.offset, -1);
        const double width = width_of(facet.corners, middle, picture.scale);
        if (!facet.masked) sum.doubt = std::min(sum.doubt, std::abs(width - 1));
        if (facet.masked || width < 1) {
            if (q == p) filling = -1 / facet.position.z, filling_placement = facet.masked ? 0 : facet.placement;
            continue;
        }
        for (uint32_t i = 0; i < kPixelPoints; ++i) {
            const Passing passing =
                pass(facet.corners, dvec3(picture.scale * places[i] + picture.offset, -1), picture.scale);
            sum.doubt = std::min(sum.doubt, std::abs(passing.inside));
            if (passing.inside >= 0) nearest[i] = std::max(nearest[i], passing.inverse_depth);
        }
    }
    for (const SmallTriangle& t : triangles) {
        if (t.widening > 1) continue;
        for (uint32_t i = 0; i < kPixelPoints; ++i) {
            const double inside = t.inside(places[i]);
            sum.doubt = std::min(sum.doubt, std::abs(inside));
            if (inside >= 0) nearest[i] = std::max(nearest[i], t.depth(places[i]));
        }
    }
    const auto hides = [&](double inverse_depth, double other) {
        const double before = inverse_depth / other - 1 - 3e-6;
        // Float has 6e-8 of a depth, and of such a plane as much a hundred times.
        if (inverse_depth > 0) sum.doubt = std::min(sum.doubt, std::abs(before) * 1e3);
        return before > 0;
    };
    double share = 0;
    for (const SmallTriangle& t : triangles) {
        const double area = t.widening > 0 ? area_within(t.silhouette, p.x, p.y) / t.widening : 0;
        if (!(area > 0)) continue;
        double within = 0, seen = 0, closest = -1e30, next = -1e30, of_closest = 0;
        for (uint32_t i = 0; i < kPixelPoints; ++i) {
            const double inside = t.inside(places[i]);
            sum.doubt = std::min(sum.doubt, std::abs(inside));
            const double visible = hides(nearest[i], t.depth(places[i])) ? 0 : 1;
            if (inside >= 0) within += 1, seen += visible;
            next = std::max(next, std::min(closest, inside));
            if (inside > closest) closest = inside, of_closest = visible;
        }
        if (within == 0) sum.doubt = std::min(sum.doubt, closest - next);
        const double here = t.depth(dvec2(p) + 0.5);
        const bool is_listed = filling_placement == t.placement && 1 / here - 1 / filling <= t.reach;
        if (filling > 0) sum.doubt = std::min(sum.doubt, std::abs((1 / here - 1 / filling) / t.reach - 1) * 1e2);
        if (!is_listed && hides(filling, here)) continue;
        const double visible = area * (within > 0 ? seen / within : of_closest);
        sum.luminance += t.luminance * visible;
        share += visible;
    }
    sum.luminance /= std::max(share, 1.0);
    return sum;
}

}  // namespace vesper::reference
