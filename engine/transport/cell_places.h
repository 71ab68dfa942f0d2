// Places on the surfaces of a scene, a few for each cell. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "transport/cell_grid.h"
#include "transport/surface_cells.h"
#include "transport/surfaces.h"

namespace vesper::transport {

/// How much a place sees of what is far. Near: of some directions by chance one ends close by. Partly: some end at the
/// back of a surface. Air: the place is on no surface. Covered: most directions end at backs of bodies, or the place
/// is under another surface or within a body.
enum class Exposure : uint8_t { Open, Near, Partly, Air, Covered };

/// What was found on the surfaces of a cell.
struct CellPlaces {
    static constexpr uint32_t kMost = 8;

    struct Place {
        glm::vec3 point{0};  ///< from the middle of the cube, m
        glm::vec3 normal{0};
        uint32_t node = 0;         ///< scene::kNone in the air
        uint32_t reflectance = 0;  ///< glm::packF3x9_E1x5
        float weight = 0;
    };
    std::array<Place, kMost> places;  ///< count() of all that were seen, each as likely
    uint32_t seen = 0;
    Exposure exposure = Exposure::Open;  ///< of all of these
    double weight = 0;                   ///< of all
    double area = 0;                     ///< of those and of less open ones that are not covered, m^2
    glm::dvec3 point{0};                 ///< from the middle of the cube, m; this and what follows: times weight
    glm::dvec3 normal{0}, reflectance{0};
    CellCut cut;

    uint32_t count() const { return std::min(seen, kMost); }
    /// Only the places for which a bit is set; sums become those of these.
    void keep(uint32_t which);
};
using PlacesByCell = std::map<uint32_t, CellPlaces>;

/// A place on a surface, in the world.
struct FoundPlace {
    glm::dvec3 point, normal, reflectance;
    uint32_t node;
    double weight, area;
    Exposure exposure;
};

/// Adds a place to the cell `number` of `grid`. They count where it has none that are more open.
void add_place(CellPlaces& cell, const CellGrid& grid, uint32_t number, const FoundPlace& place);

/// Places all over the triangles, and in the air over ground and floors, where things move. Ends early with more than
/// `most` cells, so that memory is bounded: larger ones are wanted. `progress` is called with shares from 0 to 1, from
/// this thread; where it returns false there is no result. On all processors; however many they are, the result is the
/// same.
std::optional<PlacesByCell> find_places(const scene::Scene& scene, std::span<const glm::dmat4> world,
                                        const rays::RayCaster& rays, const Surfaces& surfaces,
                                        const SurfaceCells& cells, size_t most,
                                        const std::function<bool(double)>& progress);

}  // namespace vesper::transport
