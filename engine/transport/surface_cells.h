// Which cells the surfaces of a scene have. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <unordered_set>

#include "transport/cell_grid.h"
#include "transport/emitters.h"
#include "transport/radiosity.h"

namespace vesper::transport {

/// Those of a grid. Where a scene is too large for that, surfaces far from all lamps and emitters have cells of the air
/// instead, which are larger: light varies less there.
struct SurfaceCells {
    static constexpr double kRegion =
        32;  ///< cubes of space, m: those with a lamp or an emitter and all around them are near
    static constexpr double kUsualSize = 1;  ///< of a cube, m: smaller ones are for small scenes

    CellGrid grid;

    /// None if there is no surface. Cubes are as small as settings.fine_cells and settings.most_cells allow.
    static std::optional<SurfaceCells> of(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                          const Emitters& emitters, const RadiositySettings& settings);

    static double larger(double size);  ///< the next size, m
    /// How many cells of a size there may be, roughly.
    static uint64_t most(const RadiositySettings& settings, double size) {
        return std::max<uint64_t>(size < kUsualSize ? settings.fine_cells : settings.most_cells, 1);
    }
    bool is_fine(glm::dvec3 point) const { return all_fine_ || near_.contains(region_of(point)); }
    std::optional<uint32_t> number(glm::dvec3 point, glm::dvec3 normal) const {
        return is_fine(point) ? grid.cell_at(point, normal) : air(point, side_of(normal));
    }
    std::optional<uint32_t> air(glm::dvec3 point, uint32_t side) const {
        return grid.air_cell(grid.place(point) / double(grid.air_cubes()), side);
    }

private:
    uint64_t region_of(glm::dvec3 point) const;
    void add_near(glm::dvec3 low, glm::dvec3 high);

    bool all_fine_ = true;
    glm::dvec3 regions_from_{0};         // m
    std::unordered_set<uint64_t> near_;  // by region_of()
};

}  // namespace vesper::transport
