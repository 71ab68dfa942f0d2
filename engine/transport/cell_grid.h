// Surfaces of a scene by where they are and which way they face. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

namespace vesper::transport {

/// Sides: +x, -x, +y, -y, +z, -z.
constexpr uint32_t kSides = 6;
/// Before components along each axis are compared they are multiplied by this, so that rounding does not decide about a
/// plane that goes to two sides as much.
constexpr glm::dvec3 kSideFactors{1.0002, 1.0001, 1};
/// The one that a direction goes to most.
uint32_t side_of(glm::dvec3 direction);
glm::dvec3 direction_of(uint32_t side);  ///< unit length
/// Of a vector, the component to a side.
double along(glm::dvec3 v, uint32_t side);

/// Space in cubes. A cell is what lies in one cube and faces one of its sides most. Beside those of surfaces there are
/// cells of the air in cubes kAir times as large, for what moves in it.
struct CellGrid {
    static constexpr uint32_t kAir = 4;

    glm::dvec3 origin{0};  ///< m, world
    double size = 1;       ///< of a cube, m
    glm::uvec3 count{0};   ///< cubes along each axis

    /// Around a box. Cubes have the size `least`, or the least power of two of it for which cells have 32-bit numbers.
    static CellGrid around(glm::dvec3 low, glm::dvec3 high, double least);

    /// Cells are numbered by cube, x first, then by side; first all of surfaces, then those of air. None beyond the
    /// grid.
    std::optional<uint32_t> cell(glm::dvec3 cube, uint32_t side) const;
    std::optional<uint32_t> cell_at(glm::dvec3 point, glm::dvec3 normal) const;
    std::optional<uint32_t> air_cell(glm::dvec3 cube, uint32_t side) const;  ///< in cubes of air
    bool is_air(uint32_t cell) const { return cell >= air_begins(); }
    uint32_t air_begins() const { return count.x * count.y * count.z * kSides; }
    glm::uvec3 air_count() const { return (count + kAir - 1u) / kAir; }
    /// In cubes.
    glm::dvec3 place(glm::dvec3 point) const { return (point - origin) / size; }
    uint32_t side(uint32_t cell) const { return cell % kSides; }
    glm::dvec3 middle(uint32_t cell) const;  ///< of its cube, m, world
};

}  // namespace vesper::transport
