// The ground around roads: heights on a grid, always below the roads. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::roads {

/// Heights over the plane of the file's frame, bilinear between the nodes of a grid.
class Ground {
public:
    static constexpr double kBelow = 0.06;  ///< m of the ground below a road

    Ground() = default;
    /// A grid over a rectangle with cells of at least `cell` m; larger if there were too many.
    Ground(glm::dvec2 low, glm::dvec2 high, double cell);

    /// Keeps the ground below this point, and 1.5 cells around it.
    void stay_below(glm::dvec3 point);
    /// Extends the known heights smoothly to all other nodes.
    void spread();

    double cell() const { return cell_; }
    uint32_t columns() const { return columns_; }
    uint32_t rows() const { return rows_; }
    glm::dvec3 node(uint32_t column, uint32_t row) const;
    double height(glm::dvec2 at) const;
    glm::dvec3 normal(uint32_t column, uint32_t row) const;

private:
    size_t index(uint32_t column, uint32_t row) const { return size_t(row) * columns_ + column; }

    glm::dvec2 low_{0};
    double cell_ = 1;
    uint32_t columns_ = 0, rows_ = 0;
    std::vector<double> heights_;
};

}  // namespace vesper::roads
