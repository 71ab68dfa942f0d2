// Which lamps light which froxel, by looking at many points of it. SPDX-License-Identifier: MIT
// Clustered shading after Olsson, Billeter and Assarsson 2012. The search only ever finds lamps that do reach a froxel,
// so a correct list holds at least these.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "shared/cluster.h"

namespace vesper::reference {

using glm::dvec2, glm::dvec3, glm::dvec4;

enum class LampKind { Cone, Power, Table, Directional };

/// Lamps are sorted by kind (shared/lamp.h).
inline LampKind kind_of(size_t index, const shared::LampCounts& counts) {
    if (index < counts.cones) return LampKind::Cone;
    if (index < size_t(counts.cones) + counts.powers) return LampKind::Power;
    return index < size_t(counts.cones) + counts.powers + counts.tables ? LampKind::Table : LampKind::Directional;
}

/// Luminous intensity towards a direction at `cosine` to the axis, cd. Cone: the squared ramp of KHR_lights_punctual.
inline double intensity(const shared::Lamp& lamp, LampKind kind, double cosine) {
    switch (kind) {
        case LampKind::Cone: {
            const double ramp = std::clamp(lamp.lobe_a * cosine + lamp.lobe_b, 0.0, 1.0);
            return lamp.intensity * ramp * ramp;
        }
        case LampKind::Power:
            if (cosine <= 0) return 0;  // also for exponent 0: nothing goes backwards
            return lamp.intensity * std::pow(cosine, double(lamp.lobe_a));
        case LampKind::Table:  // not by the cosine alone
        case LampKind::Directional:
            break;
    }
    return lamp.intensity;
}

/// Illuminance of a lamp on a surface that faces it, lx: I / d^2, the inverse square law.
inline double facing_illuminance(const shared::Lamp& lamp, LampKind kind, dvec3 point) {
    if (kind == LampKind::Directional) return lamp.intensity;
    const dvec3 to_lamp = dvec3(lamp.position) - point;
    const double d2 = glm::dot(to_lamp, to_lamp);
    const double cosine = d2 > 0 ? glm::dot(dvec3(lamp.axis), -to_lamp) / std::sqrt(d2) : 1.0;
    return intensity(lamp, kind, cosine) / d2;
}

/// Distance beyond which a lamp gives less than `threshold` lx in any direction, m.
inline double light_radius(const shared::Lamp& lamp, LampKind kind, double threshold) {
    const double brightest = std::max(intensity(lamp, kind, 1.0), intensity(lamp, kind, -1.0));
    return std::sqrt(brightest / threshold);
}

/// Depth at which a slice begins, m, as shared::ClusterGrid maps depths: the first begins at the eye.
inline double slice_depth(const shared::ClusterGrid& grid, uint32_t slice) {
    return slice == 0 ? 0 : std::exp2((double(slice) - grid.slice_bias) / grid.slice_scale);
}

inline uint32_t slice_of(const shared::ClusterGrid& grid, double depth) {
    const double s = std::floor(std::log2(depth) * grid.slice_scale + grid.slice_bias);
    return uint32_t(std::clamp(s, 0.0, double(grid.slices) - 1));
}

/// Index of a froxel: x fastest, then y, then slices.
inline uint32_t froxel_index(const shared::ClusterGrid& grid, uint32_t tile_x, uint32_t tile_y, uint32_t slice) {
    return (slice * grid.tiles_y + tile_y) * grid.tiles_x + tile_x;
}

inline uint32_t tile_of(uint32_t pixel) { return pixel / shared::kTileSize; }

/// Whether anything is drawn in a froxel; float logarithms may put what lies at its border on either side.
enum class Drawn { Nothing, AtItsBorder, Something };

/// Of every froxel, given the depths of all pixels, m; 0: nothing is drawn.
inline std::vector<Drawn> drawn_in(const shared::ClusterGrid& grid, shared::uvec2 size, std::span<const float> depths) {
    std::vector<Drawn> drawn(size_t(grid.tiles_x) * grid.tiles_y * grid.slices, Drawn::Nothing);
    for (size_t i = 0; i < depths.size(); ++i) {
        if (!(depths[i] > 0)) continue;
        const uint32_t x = tile_of(uint32_t(i % size.x)), y = tile_of(uint32_t(i / size.x));
        const uint32_t low = slice_of(grid, 0.99999 * depths[i]), high = slice_of(grid, 1.00001 * depths[i]);
        for (const uint32_t slice : {low, high}) {
            Drawn& here = drawn[froxel_index(grid, x, y, slice)];
            here = std::max(here, low == high ? Drawn::Something : Drawn::AtItsBorder);
        }
    }
    return drawn;
}

/// View-frame position of pixel coordinates (0.5 is the middle of the first) at a depth, m.
inline dvec3 view_position(const shared::ClusterGrid& grid, dvec2 pixel, double depth) {
    const dvec2 ray = dvec2(grid.ray_scale) * pixel + dvec2(grid.ray_offset);
    return depth * dvec3(ray, -1.0);
}

/// The pixel centres of a tile that exist, between two depths.
struct Froxel {
    dvec2 pixel_low{0}, pixel_high{0};
    double near = 0, far = 0;  ///< m

    dvec3 at(const shared::ClusterGrid& grid, dvec3 t) const {  ///< t in [0, 1]^3
        return view_position(grid, glm::mix(pixel_low, pixel_high, dvec2(t)), near + (far - near) * t.z);
    }
    /// The t of the point of the froxel that is near a point of the view frame (0 < -z).
    dvec3 nearest(const shared::ClusterGrid& grid, dvec3 point) const {
        const dvec2 pixel = (dvec2(point) / -point.z - dvec2(grid.ray_offset)) / dvec2(grid.ray_scale);
        const dvec3 span = glm::max(dvec3(pixel_high - pixel_low, far - near), dvec3(1e-12));
        return glm::clamp(dvec3(pixel - pixel_low, -point.z - near) / span, dvec3(0), dvec3(1));
    }
    std::array<dvec3, 8> corners(const shared::ClusterGrid& grid) const {
        std::array<dvec3, 8> points;
        for (int i = 0; i < 8; ++i) points[size_t(i)] = at(grid, dvec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
        return points;
    }
};

/// The last slice ends at `far`.
inline Froxel froxel(const shared::ClusterPush& p, shared::uvec2 size, uint32_t tile_x, uint32_t tile_y,
                     uint32_t slice) {
    const auto last = [](uint32_t tile, uint32_t pixels) {
        return std::min((tile + 1) * shared::kTileSize, pixels) - 0.5;
    };
    return {dvec2(tile_x, tile_y) * double(shared::kTileSize) + 0.5, dvec2(last(tile_x, size.x), last(tile_y, size.y)),
            slice_depth(p.grid, slice), slice + 1 == p.grid.slices ? double(p.far) : slice_depth(p.grid, slice + 1)};
}

/// The largest illuminance found in a froxel, lx, by `steps`^3 samples, others where the lamp's axis comes near, and a
/// pattern search from the best of them. Never more than the true maximum.
inline double brightest(const shared::ClusterGrid& grid, const Froxel& f, const shared::Lamp& lamp, LampKind kind,
                        int steps = 5) {
    const auto value = [&](dvec3 t) { return facing_illuminance(lamp, kind, f.at(grid, t)); };
    double best = -1;
    dvec3 at{0.5};
    for (int k = 0; k < steps; ++k)
        for (int j = 0; j < steps; ++j)
            for (int i = 0; i < steps; ++i) {
                const dvec3 t = dvec3(i, j, k) / double(steps - 1);
                if (const double e = value(t); e > best) best = e, at = t;
            }
    for (double along = 0.01; along < 1e4; along *= 1.05) {
        const dvec3 point = dvec3(lamp.position) + along * dvec3(lamp.axis);
        if (point.z >= 0) continue;
        const dvec3 t = f.nearest(grid, point);
        if (const double e = value(t); e > best) best = e, at = t;
    }
    for (double step = 0.5 / (steps - 1); step > 1e-4; step *= 0.5)
        for (bool moved = true; moved;) {
            moved = false;
            for (int axis = 0; axis < 3; ++axis)
                for (double sign : {-1.0, 1.0}) {
                    dvec3 t = at;
                    t[axis] = std::clamp(t[axis] + sign * step, 0.0, 1.0);
                    if (const double e = value(t); e > best) best = e, at = t, moved = std::isfinite(e);
                }
        }
    return best;
}

/// Lamps (not directional lamps) found to give `threshold` lx somewhere in each froxel, ascending, by froxel_index.
inline std::vector<std::vector<uint32_t>> lit_froxels(const shared::ClusterPush& p, shared::uvec2 size,
                                                      std::span<const shared::Lamp> lamps, int steps = 5) {
    std::vector<std::vector<uint32_t>> lists(size_t(p.grid.tiles_x) * p.grid.tiles_y * p.grid.slices);
    // A hair above the threshold: single precision may see a lamp at the threshold either way.
    const double threshold = double(p.threshold) * (1 + 1e-5);
    for (uint32_t slice = 0; slice < p.grid.slices; ++slice)
        for (uint32_t y = 0; y < p.grid.tiles_y; ++y)
            for (uint32_t x = 0; x < p.grid.tiles_x; ++x) {
                const Froxel f = froxel(p, size, x, y, slice);
                const auto corners = f.corners(p.grid);
                dvec3 low = corners[0], high = corners[0];
                for (dvec3 c : corners) low = glm::min(low, c), high = glm::max(high, c);
                auto& list = lists[froxel_index(p.grid, x, y, slice)];
                for (uint32_t i = 0; i < p.lamps.cones + p.lamps.powers; ++i) {
                    const LampKind kind = kind_of(i, p.lamps);
                    const dvec3 lamp(lamps[i].position), away = lamp - glm::clamp(lamp, low, high);
                    // Farther than the lamp's light radius from a box around the froxel: no need to search.
                    if (glm::length(away) > light_radius(lamps[i], kind, threshold)) continue;
                    if (brightest(p.grid, f, lamps[i], kind, steps) >= threshold) list.push_back(i);
                }
            }
    return lists;
}

}  // namespace vesper::reference
