// Blocks of pixels: their classes, and the lamps that can be added up over them. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "passes/shade_reference.h"
#include "shared/blocks.h"

namespace vesper::reference {

/// The plane that a block of pixels shows.
struct BlockPlane {
    dvec3 normal{0};
    double away = 0;  ///< normal . point of the plane, m
    double kind = 0;  ///< metallic of the G-buffer: 0 or a road's
};

/// A block of the image: where it begins, px, and what its pixels show.
struct Block {
    glm::uvec2 corner{0};
    std::vector<glm::uvec2> pixels;  ///< that are drawn
    std::vector<SurfaceTexel> texels;
};

inline bool is_road(const SurfaceTexel& t) { return t.reflectance.w <= shared::kRoadKind; }
inline bool is_sheet(const SurfaceTexel& t) { return t.reflectance.w >= shared::kRetroCode; }
inline bool is_glossy(const SurfaceTexel& t) { return !is_road(t) && (t.surface.w < 1 || t.reflectance.w > 0); }

/// One of shared::kClass*. `listed`: a lamp is left on the block's list.
inline uint32_t class_of(const Block& block, bool listed) {
    const auto any = [&](auto is) { return std::any_of(block.texels.begin(), block.texels.end(), is); };
    const bool paved = any(is_road);
    if (block.texels.empty()) return shared::kClassEmpty;
    if (any(is_sheet)) return shared::kClassRetro;
    if (any(is_glossy)) return paved ? shared::kClassGlossyPaved : shared::kClassGlossy;
    if (paved) return listed ? shared::kClassPavedListed : shared::kClassPaved;
    return listed ? shared::kClassMattListed : shared::kClassMatt;
}

/// The plane, if all that is drawn lies within `lift` of its distance from the eye and `tilt`, rad, of its normal.
inline std::optional<BlockPlane> plane_of(const Block& block, const shared::ClusterGrid& grid, double tilt = 3e-4,
                                          double lift = 2e-4) {
    if (block.texels.empty()) return {};
    const auto point = [&](size_t i) {
        return view_position(grid, dvec2(block.pixels[i]) + 0.5, block.texels[i].surface.z);
    };
    const dvec3 normal = octahedral_decode(dvec2(block.texels[0].surface));
    const BlockPlane plane{normal, glm::dot(normal, point(0)), block.texels[0].reflectance.w};
    for (size_t i = 0; i < block.texels.size(); ++i) {
        const SurfaceTexel& t = block.texels[i];
        if (is_glossy(t) || is_sheet(t) || t.reflectance.w != plane.kind) return {};
        if (glm::distance(octahedral_decode(dvec2(t.surface)), normal) > tilt) return {};
        if (std::abs(glm::dot(normal, point(i)) - plane.away) > lift * t.surface.z) return {};
    }
    return plane;
}

/// A function of a place in a block, px from the image's corner.
using OfPlace = std::function<double(dvec2)>;

/// Centres of the outermost pixels and what lies halfway: node (i, j) of a block.
inline dvec2 node(const Block& block, int i, int j) { return dvec2(block.corner) + 0.5 + 3.5 * dvec2(i, j); }

/// The polynomial of degree two along either side through its values at the nodes (Lagrange).
inline double polynomial(const Block& block, const OfPlace& f, dvec2 place) {
    const auto weight = [](int node, double x) {  // x from 0 to 2
        return node == 0 ? (x - 1) * (x - 2) / 2 : node == 1 ? x * (2 - x) : x * (x - 1) / 2;
    };
    const dvec2 x = (place - dvec2(block.corner) - 0.5) / 3.5;
    double sum = 0;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) sum += weight(i, x.x) * weight(j, x.y) * f(node(block, i, j));
    return sum;
}

/// The four pixels next to the corner nodes, towards the middle: where the polynomial is compared.
inline std::array<dvec2, 4> between_nodes(const Block& block) {
    const dvec2 first = dvec2(block.corner) + 0.5;
    return {first + dvec2(1, 1), first + dvec2(6, 1), first + dvec2(1, 6), first + dvec2(6, 6)};
}

/// Of nodes and these pixels.
struct Extremes {
    double error = 0;  ///< the largest of the polynomial, at the pixels
    double least = 1e300;
};
inline Extremes extremes_of(const Block& block, const OfPlace& f) {
    Extremes found;
    const auto look_at = [&](double value) { found.least = std::min(found.least, value); };
    for (int n = 0; n < 9; ++n) look_at(f(node(block, n % 3, n / 3)));
    for (const dvec2 place : between_nodes(block)) {
        found.error = std::max(found.error, std::abs(polynomial(block, f, place) - f(place)));
        look_at(f(place));
    }
    return found;
}

/// Whether the nodes and points between tell all of a lamp: they lie in a cone of directions no wider than half its
/// beam (to where a ramp ends, or a power has fallen to exp(-1/2)) and 0.35 rad from its axis.
inline bool resolved(const BlockPlane& plane, const shared::ClusterGrid& grid, const Block& block,
                     const shared::Lamp& lamp, LampKind kind, double slack = 1) {
    const auto point = [&](dvec2 place) {
        const dvec3 ray = view_position(grid, place, 1);
        return ray * (plane.away / glm::dot(plane.normal, ray));
    };
    double radius = 0, nearest = 1e300;
    const auto look_at = [&](dvec2 place) {
        radius = std::max(radius, glm::distance(point(place), point(node(block, 1, 1))));
        nearest = std::min(nearest, glm::distance(point(place), dvec3(lamp.position)));
    };
    for (int n = 0; n < 9; ++n) look_at(node(block, n % 3, n / 3));
    for (const dvec2 place : between_nodes(block)) look_at(place);
    double beam = std::numbers::pi;
    if (kind == LampKind::Cone && lamp.lobe_a > 0)
        beam = std::acos(std::clamp(-double(lamp.lobe_b) / lamp.lobe_a, -1.0, 1.0));
    if (kind == LampKind::Power) beam = 1 / std::sqrt(std::max(double(lamp.lobe_a), 0.1));
    return radius / nearest <= slack * std::min(0.5 * beam, 0.35);
}

/// The illuminance, lx, of a lamp on the plane where a pixel sees it.
inline double light_on_plane(const BlockPlane& plane, const shared::ClusterGrid& grid, const shared::Lamp& lamp,
                             LampKind kind, dvec2 place) {
    const dvec3 ray = view_position(grid, place, 1), point = ray * (plane.away / glm::dot(plane.normal, ray));
    const dvec3 path = dvec3(lamp.position) - point;
    const double d = glm::length(path), cosine = glm::dot(plane.normal, path) / d;
    const double e = intensity(lamp, kind, -glm::dot(dvec3(lamp.axis), path) / d) * cosine / (d * d);
    return cosine > 0 ? e : 0;
}

}  // namespace vesper::reference
