// Light of cells on surfaces, one pixel after another, in double. SPDX-License-Identifier: MIT
// Each cell of the list is asked in turn what it gives a point: none but the cells of the four cubes beside each other
// across the side that are nearest, and the one of each that counts there; but none that a wall hides from the cell of
// the point's own column. Weights are tents across the side, times one along it that falls to that of another surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "gpu_scene/view.h"
#include "passes/shade_reference.h"
#include "transport/cell_grid.h"

namespace vesper::reference {

struct LitCell {
    uint32_t number;
    dvec3 light;          // lx
    double height;        // over the middle of its cube, along its side, m
    uint32_t hidden = 0;  // bits of the eight cells around it that walls hide, see step_of()
};

/// The step to a cell around another, across its side (next axis after that of the side, and the one after that).
inline glm::ivec2 step_of(uint32_t bit) {
    constexpr int kSteps[8][2]{{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    return {kSteps[bit][0], kSteps[bit][1]};
}

// In cubes: how near to a border a surface stands for the next cube too; how far off a cell's height is another
// surface.
constexpr double kNearBorder = 0.25, kSameSurface = 0.75;
constexpr double kElsewhere = 1e-3, kLeastWeight = 1e-7;  // the weight of such, and of any cell
constexpr double kAirCubes = 4;                           // side of a cube of air

/// What cells give, and how much they count.
struct CellLight {
    dvec3 light{0};
    double weight = 0;
    void add(double more, dvec3 of) { light += more * of, weight += more; }
};

/// Cells with their cubes.
class CellList {
public:
    /// `above`, `below`: light on surfaces that face up and down where there are no cells, lx; linear between them.
    CellList(const transport::CellGrid& grid, const std::vector<LitCell>& cells, dvec3 above = dvec3(0),
             dvec3 below = dvec3(0))
        : grid_(grid), above_(above), below_(below) {
        for (const LitCell& cell : cells) {
            const bool air = grid.is_air(cell.number);
            const dvec3 in_grid = (grid.middle(cell.number) - grid.origin) / grid.size,
                        middle = air ? in_grid : glm::floor(in_grid) + 0.5;
            (air ? air_ : surfaces_)[cell.number % 6].push_back(
                {middle, cell.light, cell.height / grid.size, cell.hidden});
        }
    }

    const transport::CellGrid& grid() const { return grid_; }
    dvec3 open(dvec3 normal) const { return (1 + normal.y) / 2 * above_ + (1 - normal.y) / 2 * below_; }

    /// `place` in cubes; `side` 0 to 5: +x, -x, +y, -y, +z, -z.
    CellLight on_surfaces(dvec3 place, uint32_t side) const {
        const int along = int(side / 2), across = (along + 1) % 3, over = (along + 2) % 3;
        const double way = side % 2 ? -1 : 1;
        if (!(place[along] >= 0 && place[along] < grid_.count[along])) return {};  // beyond the grid
        // Of each column of cubes the cell that counts: its own cube's, else one that is near the border to it, first
        // the lower one.
        std::map<std::pair<double, double>, std::pair<int, const Lit*>> columns;
        for (const Lit& cell : surfaces_[side]) {
            const double u = place[across] - cell.middle[across], v = place[over] - cell.middle[over];
            if (u < -1 || u >= 1 || v < -1 || v >= 1) continue;
            const double layer = std::floor(cell.middle[along]) - std::floor(place[along]);
            if (std::abs(layer) > 1) continue;
            const double to_border = 0.5 + layer * way * cell.height;  // of the cube that the point is in
            if (layer != 0 && to_border > kNearBorder) continue;
            const std::pair candidate(layer == 0 ? 0 : layer < 0 ? 1 : 2, &cell);
            const auto [known, added] = columns.try_emplace({cell.middle[across], cell.middle[over]}, candidate);
            if (candidate.first < known->second.first) known->second = candidate;
        }
        const std::pair own(std::floor(place[across]) + 0.5, std::floor(place[over]) + 0.5);
        const uint32_t hidden = columns.contains(own) ? columns.at(own).second->hidden : 0;
        CellLight sum;
        for (const auto& [column, chosen] : columns) {
            const Lit& cell = *chosen.second;
            bool behind_a_wall = false;
            for (uint32_t bit = 0; bit < 8; ++bit)
                behind_a_wall = behind_a_wall || (hidden >> bit & 1 && column.first == own.first + step_of(bit).x &&
                                                  column.second == own.second + step_of(bit).y);
            if (behind_a_wall) continue;
            const double tent =
                (1 - std::abs(place[across] - column.first)) * (1 - std::abs(place[over] - column.second));
            const double off = std::abs(place[along] - (cell.middle[along] + way * cell.height));
            const double same = std::max(1 - off / kSameSurface, kElsewhere);
            sum.add(tent * same + kLeastWeight, cell.light);
        }
        return sum;
    }

    /// Between eight cubes of air: of each the sides that the normal goes to, by the squares of its components.
    CellLight in_air(dvec3 place, dvec3 normal) const {
        CellLight sum;
        for (uint32_t side = 0; side < 6; ++side) {
            const double component = normal[int(side / 2)];
            if ((side % 2 == 1) != (component < 0)) continue;
            for (const Lit& cell : air_[side]) {
                const dvec3 off = (place - cell.middle) / kAirCubes;
                if (glm::any(glm::lessThan(off, dvec3(-1))) || glm::any(glm::greaterThanEqual(off, dvec3(1)))) continue;
                const dvec3 tent = 1.0 - glm::abs(off);
                sum.add(component * component * (tent.x * tent.y * tent.z + kLeastWeight), cell.light);
            }
        }
        return sum;
    }

private:
    struct Lit {
        dvec3 middle, light;
        double height;  // cubes
        uint32_t hidden;
    };
    transport::CellGrid grid_;
    dvec3 above_, below_;
    std::vector<Lit> surfaces_[6], air_[6];
};

/// Illuminance of a surface that faces `side` most, RGB lx; `place` in cubes, the normal of unit length.
inline dvec3 illuminance_on_side(const CellList& cells, dvec3 place, dvec3 normal, uint32_t side) {
    CellLight found = cells.on_surfaces(place, side);
    if (found.weight < 2 * kElsewhere)
        if (const CellLight air = cells.in_air(place, normal); air.weight > 0) found = air;
    return found.weight > 0 ? found.light / found.weight : cells.open(normal);
}

/// The sides that a normal goes to most, but for `rounding` of its components; the first is the one.
inline std::vector<uint32_t> sides_of(dvec3 normal, double rounding = 0) {
    const double most = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    std::vector<uint32_t> sides;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(normal[axis]) >= most - rounding) sides.push_back(uint32_t(2 * axis + (normal[axis] < 0 ? 1 : 0)));
    std::ranges::stable_sort(sides, std::greater{}, [&](uint32_t s) { return std::abs(normal[int(s / 2)]); });
    return sides;
}

/// A pixel's surface, in cubes and in the world.
struct CellPlace {
    dvec3 place, normal;
};
inline CellPlace cell_place(const transport::CellGrid& grid, const SurfaceTexel& texel, glm::dvec2 pixel_centre,
                            const gpu_scene::View& view) {
    const glm::dmat4 world = glm::inverse(glm::dmat4(view.world_to_view));
    const dvec3 at =
        texel.surface.z * dvec3(glm::dvec2(view.ray_scale()) * pixel_centre + glm::dvec2(view.ray_offset()), -1);
    return {(dvec3(world * glm::dvec4(at, 1)) - grid.origin) / grid.size,
            glm::dmat3(world) * octahedral_decode(dvec2(texel.surface))};
}

/// What a surface sends to the eye of an illuminance, cd/m^2.
inline dvec3 sent(const SurfaceTexel& texel, glm::dvec2 pixel_centre, const gpu_scene::View& view, dvec3 illuminance,
                  double lambert) {
    const dvec3 ray(glm::dvec2(view.ray_scale()) * pixel_centre + glm::dvec2(view.ray_offset()), -1);
    const double sine = -glm::dot(octahedral_decode(dvec2(texel.surface)), glm::normalize(ray));
    const bool road = texel.reflectance.w <= double(shared::kRoadKind);
    return illuminance * dvec3(texel.reflectance) * (lambert * (road ? road_in_diffuse(-texel.surface.w, sine) : 1));
}

/// One pixel of a view; `luminance` is what it had.
inline dvec3 add_indirect(const CellList& cells, const SurfaceTexel& texel, dvec3 luminance, glm::dvec2 pixel_centre,
                          const gpu_scene::View& view, double lambert) {
    if (!(texel.surface.z > 0)) return luminance;
    const CellPlace at = cell_place(cells.grid(), texel, pixel_centre, view);
    return luminance + sent(texel, pixel_centre, view,
                            illuminance_on_side(cells, at.place, at.normal, sides_of(at.normal)[0]), lambert);
}

/// The same of illuminance that is known for the pixel, lx.
inline dvec3 add_illuminance(const SurfaceTexel& texel, dvec3 luminance, dvec3 illuminance, glm::dvec2 pixel_centre,
                             const gpu_scene::View& view, double lambert) {
    if (!(texel.surface.z > 0)) return luminance;
    return luminance + sent(texel, pixel_centre, view, illuminance, lambert);
}

}  // namespace vesper::reference
