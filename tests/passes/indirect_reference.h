// Light of cells on surfaces, one pixel after another, in double. SPDX-License-Identifier: MIT
// Each cell of the list is asked in turn what it gives a point: none but those whose middles are less than a cube away
// along each axis, none that a wall hides from the cell of the point's own cube, and
// none that a cut parts from the point. Weights are tents around the
// middle, times one that falls with the distance from the plane of the cell to that of another surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "gpu_scene/view.h"
#include "passes/shade_reference.h"
#include "transport/cell_grid.h"

namespace vesper::reference {

struct LitCell {
    uint32_t number;
    dvec3 light;             // lx
    double height;           // of its plane over the middle of its cube, m
    dvec3 normal;            // of that
    uint32_t hidden = 0;     // bits of the eight cells around it that walls hide, see step_of()
    glm::dvec2 cut_way{0};   // across the plane that cuts it: unit, along the two axes after that of the side; 0: none
    double cut_at = 0;       // of that plane along it, from the middle of its cube, cubes
    bool below_cut = false;  // whether what is below it belongs, or what is above
};

/// From the 8 bits of a cut.
inline void set_cut(LitCell& cell, uint32_t bits) {
    if (bits == 0) return;
    const glm::dvec2 ways[4]{{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    cell.cut_way = glm::normalize(ways[bits / 64]);
    cell.cut_at = (bits % 32 + 0.5) / 32 - 0.5, cell.below_cut = bits / 32 % 2 == 1;
}

/// The step to a cell around another, across its side (next axis after that of the side, and the one after that).
inline glm::ivec2 step_of(uint32_t bit) {
    constexpr int kSteps[8][2]{{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    return {kSteps[bit][0], kSteps[bit][1]};
}

constexpr double kSameSurface = 0.75;                     // cubes: so far off a cell's plane is another surface
constexpr double kElsewhere = 1e-3, kLeastWeight = 1e-7;  // the weight of such, and of any cell
constexpr double kAirSize = 4, kLeastAirCubes = 4;        // side of a cube of air, at least: m, cubes

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
        : grid_(grid),
          air_cubes_(std::max(kLeastAirCubes, std::ceil(kAirSize / grid.size))),
          above_(above),
          below_(below) {
        for (const LitCell& cell : cells) {
            const bool air = grid.is_air(cell.number);
            const dvec3 in_grid = (grid.middle(cell.number) - grid.origin) / grid.size,
                        middle = air ? in_grid : glm::floor(in_grid) + 0.5;
            (air ? air_[(cell.number - grid.air_begins()) % 6] : surfaces_[cell.number % 18])
                .push_back({middle, cell.light, cell.normal, cell.height / grid.size, cell.hidden, cell});
        }
    }

    const transport::CellGrid& grid() const { return grid_; }
    dvec3 open(dvec3 normal) const { return (1 + normal.y) / 2 * above_ + (1 - normal.y) / 2 * below_; }

    /// `place` in cubes; `facing` 0 to 17: +x, -x, +y, -y, +z, -z, and between y and z, z and x, x and y.
    CellLight on_surfaces(dvec3 place, uint32_t facing) const {
        constexpr int kAfterMissing[]{1, 2, 0};
        const int along = facing < 6 ? int(facing / 2) : kAfterMissing[(facing - 6) / 4], across = (along + 1) % 3,
                  over = (along + 2) % 3;
        dvec3 own = glm::floor(place) + 0.5;
        for (const Lit& cell : surfaces_[facing])
            if (cell.middle == own && cell.is_cut_off(place, along)) {
                // To the cubes that lie that way from the middle of this one.
                const glm::dvec2 off(place[across] - own[across], place[over] - own[over]),
                    way = cell.cut.below_cut ? cell.cut.cut_way : -cell.cut.cut_way;
                for (int i = 0; i < 2; ++i)
                    if (off[i] * way[i] > 0) own[i == 0 ? across : over] += off[i] < 0 ? -1 : 1;
                break;
            }
        uint32_t hidden = 0;
        for (const Lit& cell : surfaces_[facing])
            if (cell.middle == own) hidden = cell.hidden;
        CellLight sum;
        for (const Lit& cell : surfaces_[facing]) {
            const dvec3 off = place - cell.middle;
            if (glm::any(glm::lessThan(off, dvec3(-1))) || glm::any(glm::greaterThanEqual(off, dvec3(1)))) continue;
            bool behind_a_wall = false;
            for (uint32_t bit = 0; bit < 8; ++bit)
                behind_a_wall =
                    behind_a_wall || (hidden >> bit & 1 && cell.middle[across] == own[across] + step_of(bit).x &&
                                      cell.middle[over] == own[over] + step_of(bit).y);
            if (behind_a_wall) continue;
            const dvec3 tent = 1.0 - glm::abs(off);
            const double same =
                cell.is_cut_off(place, along)
                    ? 0
                    : std::max(1 - std::abs(glm::dot(cell.normal, off) - cell.height) / kSameSurface, kElsewhere);
            sum.add(tent.x * tent.y * tent.z * same + kLeastWeight, cell.light);
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
                const dvec3 off = (place - cell.middle) / air_cubes_;
                if (glm::any(glm::lessThan(off, dvec3(-1))) || glm::any(glm::greaterThanEqual(off, dvec3(1)))) continue;
                const dvec3 tent = 1.0 - glm::abs(off);
                sum.add(component * component * (tent.x * tent.y * tent.z + kLeastWeight), cell.light);
            }
        }
        return sum;
    }

private:
    struct Lit {
        dvec3 middle, light, normal;
        double height;  // cubes
        uint32_t hidden;
        LitCell cut;

        bool is_cut_off(dvec3 place, int along) const {
            const dvec3 off = place - middle;
            const double above =
                glm::dot(glm::dvec2(off[(along + 1) % 3], off[(along + 2) % 3]), cut.cut_way) - cut.cut_at;
            return cut.below_cut ? above > 0 : above < 0;
        }
    };
    transport::CellGrid grid_;
    double air_cubes_;
    dvec3 above_, below_;
    std::vector<Lit> surfaces_[18], air_[6];
};

/// Illuminance of a surface, RGB lx; `place` in cubes, the normal of unit length.
inline dvec3 illuminance_on(const CellList& cells, dvec3 place, dvec3 normal, uint32_t facing) {
    CellLight found = cells.on_surfaces(place, facing);
    if (found.weight < 2 * kElsewhere)
        if (const CellLight air = cells.in_air(place, normal); air.weight > 0) found = air;
    return found.weight > 0 ? found.light / found.weight : cells.open(normal);
}

/// The facings nearest to a normal, among the six sides and the twelve ways between two of them, but for `rounding` of
/// its components; the first is the one. A component along x counts 0.02 % more than it is, along y 0.01 %, and a way
/// between two sides begins where the smaller component is 0.414 of the larger one.
inline std::vector<uint32_t> facings_of(dvec3 normal, double rounding = 0) {
    const dvec3 counted = glm::abs(normal) * dvec3(1.0002, 1.0001, 1);
    struct Way {
        uint32_t facing;
        double towards;
    };
    std::vector<Way> ways;
    const auto signs = [&](int a, int b) { return (normal[a] < 0 ? 2u : 0u) + (normal[b] < 0 ? 1u : 0u); };
    const double border = 1 / (1 + 0.414);  // part of the sum of two that the larger one is there
    for (int axis = 0; axis < 3; ++axis) {
        ways.push_back({uint32_t(2 * axis + (normal[axis] < 0 ? 1 : 0)), counted[axis]});
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        ways.push_back({6 + 4 * uint32_t(axis) + signs(a, b), border * (counted[a] + counted[b])});
    }
    std::ranges::stable_sort(ways, std::greater{}, &Way::towards);
    std::vector<uint32_t> facings;
    for (const Way& way : ways)
        if (way.towards >= ways[0].towards - 2 * rounding) facings.push_back(way.facing);
    return facings;
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
                            illuminance_on(cells, at.place, at.normal, facings_of(at.normal)[0]), lambert);
}

/// The same of illuminance that is known for the pixel, lx.
inline dvec3 add_illuminance(const SurfaceTexel& texel, dvec3 luminance, dvec3 illuminance, glm::dvec2 pixel_centre,
                             const gpu_scene::View& view, double lambert) {
    if (!(texel.surface.z > 0)) return luminance;
    return luminance + sent(texel, pixel_centre, view, illuminance, lambert);
}

}  // namespace vesper::reference
