// Surfaces of a scene by where they are and which way they face. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include <glm/glm.hpp>

namespace vesper::transport {

/// Sides: +x, -x, +y, -y, +z, -z.
constexpr uint32_t kSides = 6;
/// Before components along each axis are compared they are multiplied by this, so that rounding does not decide about a
/// plane that goes to two of them as much.
constexpr glm::dvec3 kSideFactors{1.0002, 1.0001, 1};
/// The one that a direction goes to most.
uint32_t side_of(glm::dvec3 direction);

/// Facings of surfaces: the six sides, then the twelve ways between two of them, so that surfaces at right angles never
/// face the same. Of those without x first, then those without y, then those without z: by the signs of the two axes
/// after the missing one, ++, +-, -+, --.
constexpr uint32_t kFacings = 18;
/// A direction goes between two sides where the second largest component is more than this part of the largest: the
/// tangent of 22.5 degrees, a little less, for the same reason as kSideFactors.
constexpr double kBetween = 0.414;
uint32_t facing_of(glm::dvec3 direction);
glm::dvec3 direction_of(uint32_t facing);  ///< unit length
/// The axis of a side; between two sides the first after the missing one.
int axis_of(uint32_t facing);

/// A plane that cuts a cell: where a wall or a slab goes through its cube, only the surfaces on one side of it belong
/// to the cell. It stands on the cell's side, along the axis of what it faces, across one of four ways: the two axes
/// after that, the diagonal between them, and that from the first away from the second. A place along a way is in
/// cubes, 0.5 in the middle of the cube.
struct CellCut {
    static constexpr uint32_t kSteps = 32, kWays = 4;

    uint8_t bits = 0;  ///< from below: 5 of its place along the way, whether what is below it belongs, 2 of the way

    /// At the next step beyond `at`, from what belongs; at 1/64 and 63/64 at the ends, one step on at one of these.
    static CellCut across(uint32_t way, double at, bool below);
    /// Unit length, along the side.
    static glm::dvec3 direction(uint32_t way, uint32_t facing);
    static double along(uint32_t way, glm::dvec3 point, uint32_t facing);  ///< `point` from the cube's lowest corner
    bool any() const { return bits != 0; }
    uint32_t way() const { return bits >> 6u; }
    /// Whether a point belongs, as far as the plane says; from the lowest corner of the cube, in cubes.
    bool has(glm::dvec3 point, uint32_t facing) const;
    /// From the cube of a point that does not belong to the one whose cell it goes to: beside it, where the point lies
    /// on the way beyond the plane from the middle of the cube.
    glm::dvec3 beyond(glm::dvec3 point, uint32_t facing) const;
};

/// Space in cubes. A cell is what lies in one cube and faces the same. Beside those of surfaces there are cells of the
/// air in larger cubes, for what moves in it, of sides alone.
struct CellGrid {
    static constexpr double kAirSize = 4;          ///< of a cube of air, m, at least
    static constexpr uint32_t kLeastAirCubes = 4;  ///< that one is as wide as

    glm::dvec3 origin{0};  ///< m, world
    double size = 1;       ///< of a cube, m
    glm::uvec3 count{0};   ///< cubes along each axis

    /// Around a box. Cubes have the size `least`, or the least power of the root of 2 times it for which cells have
    /// 32-bit numbers.
    static CellGrid around(glm::dvec3 low, glm::dvec3 high, double least);

    /// Cells are numbered by cube, x first, then by what they face; first all of surfaces, then those of air. None
    /// beyond the grid.
    std::optional<uint32_t> cell(glm::dvec3 cube, uint32_t facing) const;
    std::optional<uint32_t> cell_at(glm::dvec3 point, glm::dvec3 normal) const;
    std::optional<uint32_t> air_cell(glm::dvec3 cube, uint32_t side) const;  ///< in cubes of air
    bool is_air(uint32_t cell) const { return cell >= air_begins(); }
    uint32_t air_begins() const { return count.x * count.y * count.z * kFacings; }
    uint32_t air_cubes() const;  ///< along each axis of a cube of air
    glm::uvec3 air_count() const { return (count + air_cubes() - 1u) / air_cubes(); }
    /// In cubes.
    glm::dvec3 place(glm::dvec3 point) const { return (point - origin) / size; }
    uint32_t facing(uint32_t cell) const { return is_air(cell) ? (cell - air_begins()) % kSides : cell % kFacings; }
    glm::dvec3 middle(uint32_t cell) const;  ///< of its cube, m, world
};

}  // namespace vesper::transport
