// Which cells the surfaces of a scene have. SPDX-License-Identifier: MIT
#pragma once

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

    CellGrid grid;

    /// None if there is no surface. Cubes are larger than settings.cell_size where there would be more cells than
    /// settings.most_cells.
    static std::optional<SurfaceCells> of(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                          const Emitters& emitters, const RadiositySettings& settings);

    bool is_fine(glm::dvec3 point) const { return all_fine_ || near_.contains(region_of(point)); }
    std::optional<uint32_t> number(glm::dvec3 point, glm::dvec3 normal) const {
        return is_fine(point) ? grid.cell_at(point, normal) : air(point, side_of(normal));
    }
    std::optional<uint32_t> air(glm::dvec3 point, uint32_t side) const {
        return grid.air_cell(grid.place(point) / double(CellGrid::kAir), side);
    }

private:
    uint64_t region_of(glm::dvec3 point) const;
    void add_near(glm::dvec3 low, glm::dvec3 high);

    bool all_fine_ = true;
    glm::dvec3 regions_from_{0};         // m
    std::unordered_set<uint64_t> near_;  // by region_of()
};

}  // namespace vesper::transport
