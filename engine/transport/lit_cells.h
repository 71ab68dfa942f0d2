// Where lit surfaces lie, so that rays are sent there. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "transport/cell_grid.h"
#include "transport/patch.h"

namespace vesper::transport {

/// Cones of directions, one of which is taken by chance. Directions within a cone are as likely.
class RayGuide {
public:
    void add(glm::dvec3 axis, double cosine, double weight);

    bool any() const { return !cones_.empty(); }
    /// Both numbers from 0 to 1.
    glm::dvec3 direction(glm::dvec2 chance) const;
    double density(glm::dvec3 direction) const;  ///< of a unit vector, 1/sr

private:
    struct Cone {
        glm::dvec3 axis;
        double cosine;  // of its half angle
        double end;     // sum of weights up to and with it
    };
    std::vector<Cone> cones_;
};

/// Cells that lamps light, in a tree of cubes, each of which is in one twice as large.
class LitCells {
public:
    struct Cell {
        uint32_t number;   ///< in the grid; of surfaces
        glm::dvec3 place;  ///< on them, m, world
        double flux;       ///< that they reflect, lm
    };
    LitCells() = default;
    LitCells(const CellGrid& grid, std::span<const Cell> cells);

    /// To cells and cubes of them, in proportion to about the illuminance that they give a patch.
    RayGuide guide(const Patch& patch) const;

private:
    struct Node {
        glm::dvec3 centre;                  // of a sphere around its cells, m
        double radius;                      // m
        std::array<double, kSides> fluxes;  // to each side, lm
        uint32_t first, count;              // below it; count 0: one cube
    };
    static double light_of(const Node& node, const Patch& patch);

    std::vector<Node> nodes_;  // the last is the root
};

}  // namespace vesper::transport
