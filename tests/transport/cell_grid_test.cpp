// Numbers of cells and where they are. SPDX-License-Identifier: MIT
#include "transport/cell_grid.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace vesper::test::cell_grid_test {
namespace {

using glm::dvec3, transport::CellGrid, transport::kFacings, transport::kSides;

const CellGrid kGrid{.origin = {-3.5, 100, 7}, .size = 0.5, .count = {7, 5, 9}};

TEST(CellGrid, ADirectionGoesToTheSideItPointsAtMost) {
    for (uint32_t side = 0; side < kSides; ++side) {
        const dvec3 direction = transport::direction_of(side);
        EXPECT_EQ(transport::side_of(direction), side);
        EXPECT_EQ(transport::facing_of(direction), side);
        EXPECT_EQ(transport::side_of(3.0 * direction + dvec3(0.9, -1.1, 1.3) * 0.5), side) << "by a slope";
        EXPECT_EQ(direction[transport::axis_of(side)], side % 2 ? -1 : 1);
    }
    // Of equal ones the first axis, as the shader has it.
    EXPECT_EQ(transport::side_of({1, 1, 1}), 0u);
    EXPECT_EQ(transport::side_of({-1, 1, 1}), 1u);
    EXPECT_EQ(transport::side_of({0.5, -1, 1}), 3u);
    EXPECT_EQ(transport::side_of({0.5, 1, -1}), 2u);
}

// Each direction faces what it is nearest to, of all eighteen.
TEST(CellGrid, ADirectionFacesWhatIsNearest) {
    std::set<uint32_t> found;
    for (int z = -20; z <= 20; ++z)
        for (int y = -20; y <= 20; ++y)
            for (int x = -20; x <= 20; ++x) {
                const dvec3 direction(x + 0.013, y + 0.027, z - 0.031);
                const uint32_t facing = transport::facing_of(direction);
                ASSERT_LT(facing, kFacings);
                found.insert(facing);
                for (uint32_t other = 0; other < kFacings; ++other)
                    EXPECT_GE(glm::dot(direction, transport::direction_of(facing)),
                              0.999 * glm::dot(direction, transport::direction_of(other)))
                        << x << ", " << y << ", " << z;
            }
    EXPECT_EQ(found.size(), kFacings);
    for (uint32_t facing = 0; facing < kFacings; ++facing) {
        const dvec3 direction = transport::direction_of(facing);
        EXPECT_EQ(transport::facing_of(direction), facing);
        EXPECT_NEAR(glm::length(direction), 1, 1e-15);
        EXPECT_NE(direction[transport::axis_of(facing)], 0);
    }
    EXPECT_EQ(transport::direction_of(6 + 4 * 2 + 1), dvec3(1, -1, 0) * std::sqrt(0.5)) << "+x and -y";
    // Directions as near to several go to the first, whatever rounding does.
    for (const double less : {1.0, 1 - 1e-6, 1 + 1e-6}) {
        EXPECT_EQ(transport::facing_of({1, 1, less}), 6u + 4 * 2);
        EXPECT_EQ(transport::facing_of({1, 0, less * std::tan(std::numbers::pi / 8)}), 6u + 4);
    }
}

// Of all surfaces at right angles no two face the same.
TEST(CellGrid, SurfacesAtRightAnglesFaceOthers) {
    for (double turn = 0; turn < 6.3; turn += 0.05)
        for (double lean = -1.5; lean <= 1.5; lean += 0.05) {
            const dvec3 normal(std::cos(turn) * std::cos(lean), std::sin(lean), std::sin(turn) * std::cos(lean));
            const dvec3 across(-std::sin(turn), 0, std::cos(turn)), up = glm::cross(normal, across);
            for (double around = 0; around < 6.3; around += 0.1)
                EXPECT_NE(transport::facing_of(normal),
                          transport::facing_of(std::cos(around) * across + std::sin(around) * up));
        }
}

TEST(CellGrid, EveryCellHasANumberOfItsOwnAndThoseOfAirComeLast) {
    std::set<uint32_t> numbers;
    uint32_t expected = 0;
    const glm::uvec3 air = kGrid.air_count();
    EXPECT_EQ(air, glm::uvec3(1, 1, 2)) << "in cubes of 4 m, that cover all";
    for (const bool of_air : {false, true}) {
        const glm::uvec3 count = of_air ? air : kGrid.count;
        for (uint32_t z = 0; z < count.z; ++z)
            for (uint32_t y = 0; y < count.y; ++y)
                for (uint32_t x = 0; x < count.x; ++x)
                    for (uint32_t facing = 0; facing < (of_air ? kSides : kFacings); ++facing) {
                        const dvec3 cube(x, y, z);
                        const auto number = of_air ? kGrid.air_cell(cube, facing) : kGrid.cell(cube, facing);
                        ASSERT_TRUE(number);
                        EXPECT_EQ(*number, expected++) << "x first, then y and z, what they face fastest";
                        EXPECT_EQ(kGrid.is_air(*number), of_air);
                        EXPECT_EQ(kGrid.facing(*number), facing);
                        EXPECT_TRUE(numbers.insert(*number).second);
                    }
        if (!of_air) {
            EXPECT_EQ(expected, kGrid.air_begins());
        }
    }
}

TEST(CellGrid, MiddlesAreThoseOfTheCellAtAPoint) {
    for (uint32_t number = 0; number < kGrid.air_begins(); ++number) {
        const dvec3 normal = transport::direction_of(kGrid.facing(number)), middle = kGrid.middle(number);
        EXPECT_EQ(kGrid.cell_at(middle, normal), number);
        // Anywhere in the cube.
        EXPECT_EQ(kGrid.cell_at(middle + dvec3(0.24, -0.24, 0.24), normal), number);
    }
    const auto air_at = [](dvec3 point, uint32_t side) { return kGrid.air_cell(kGrid.place(point) / 8.0, side); };
    const glm::uvec3 air = kGrid.air_count();
    for (uint32_t number = kGrid.air_begins(); number < kGrid.air_begins() + air.x * air.y * air.z * kSides; ++number) {
        const dvec3 middle = kGrid.middle(number);
        EXPECT_EQ(air_at(middle, kGrid.facing(number)), number);
        EXPECT_EQ(air_at(middle + dvec3(1.99, -1.99, 1.99), kGrid.facing(number)), number);
    }
    EXPECT_EQ(kGrid.place({-3.0, 101, 10}), dvec3(1, 2, 6));
}

TEST(CellGrid, CubesOfAirAreOfFourMetresAndFourCubesAtLeast) {
    constexpr double kSizesAndCubes[][2]{{0.125, 32}, {0.3, 14}, {0.5, 8}, {1 / std::numbers::sqrt2, 6},
                                         {1, 4},      {3, 4}};
    for (const auto& [size, cubes] : kSizesAndCubes)
        EXPECT_EQ((CellGrid{.size = size, .count = {100, 100, 100}}.air_cubes()), cubes) << size;
}

TEST(CellGrid, BeyondItNothingHasANumber) {
    const dvec3 inside = kGrid.middle(0), up(0, 1, 0);
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double begin = kGrid.origin[axis], end = begin + 0.5 * kGrid.count[axis],
                     air_end = begin + 4.0 * kGrid.air_count()[axis];
        for (const double to : {begin - 1e-9, end + 1e-9, 1e30, -1e30, nan, inf, -inf}) {
            dvec3 point = inside;
            point[axis] = to;
            EXPECT_FALSE(kGrid.cell_at(point, up)) << axis << " at " << to;
            if (to > begin && to < air_end) continue;
            EXPECT_FALSE(kGrid.air_cell(kGrid.place(point) / 8.0, 0)) << axis << " at " << to;
        }
    }
    EXPECT_FALSE(CellGrid{}.cell_at({0, 0, 0}, up));
}

// Cubes have the least size where they fit; surfaces on the border of the box lie in the middle of a cube.
TEST(CellGrid, IsAroundItsBox) {
    const dvec3 low(-10, 0, 3), high(27.3, 8.2, 3);
    const CellGrid grid = CellGrid::around(low, high, 0.75);
    EXPECT_EQ(grid.size, 0.75);
    for (const dvec3 corner : {low, high, dvec3(low.x, high.y, low.z)})
        for (uint32_t facing = 0; facing < kFacings; ++facing)
            EXPECT_TRUE(grid.cell_at(corner, transport::direction_of(facing)));
    EXPECT_EQ(grid.middle(0), low);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_LE(grid.count[axis], (high - low)[axis] / 0.75 + 3) << "and little is beside it";
}

// A surface on the border of the box that a place is found to be beyond, by rounding, still has a cube there: the table
// on the device has no cells beyond the grid.
TEST(CellGrid, LeavesRoomBesideItsBox) {
    for (const double extent : {7.5, 7.4999998, 7.5000002, 8.0}) {
        const CellGrid grid = CellGrid::around(dvec3(0), dvec3(extent), 1);
        const dvec3 place = grid.place(dvec3(extent));
        EXPECT_GE(place.x, 0.25) << extent;
        EXPECT_LE(place.x, grid.count.x - 0.25) << extent;
    }
}

// All numbers, those of air too, must be less than that of an empty place of the table on the device.
TEST(CellGrid, CubesGrowWhereNumbersWouldNotFit) {
    for (const dvec3 extent : {dvec3(800, 800, 800), dvec3(3e4, 200, 3e4), dvec3(2e8, 0, 0), dvec3(2e8), dvec3(1e30),
                               dvec3(0, 1e5, 5e5), dvec3(0, 0, 1e12)}) {
        const CellGrid grid = CellGrid::around(-0.5 * extent, 0.5 * extent, 1);
        const glm::dvec3 count(grid.count), air(grid.air_count());
        const double numbers = kFacings * count.x * count.y * count.z + kSides * air.x * air.y * air.z;
        EXPECT_LT(numbers, 4294967295.0) << extent.x;
        EXPECT_LE(std::max({count.x, count.y, count.z}), 0x1p24) << "whole numbers of floats";
        EXPECT_NEAR(std::exp2(std::round(2 * std::log2(grid.size)) / 2) / grid.size, 1, 1e-12);
        EXPECT_TRUE(grid.cell_at(-0.5 * extent, {0, 1, 0})) << extent.x;
        EXPECT_TRUE(grid.cell_at(0.5 * extent, {0, 1, 0})) << extent.x;
        if (grid.size > 1) {  // and no larger than needed
            const dvec3 more = extent / (grid.size / std::numbers::sqrt2) + 3.0;
            EXPECT_TRUE(kFacings * more.x * more.y * more.z > 0.75 * 4294967295.0 ||
                        std::max({more.x, more.y, more.z}) > 0x1p24)
                << extent.x;
        }
    }
    EXPECT_GT(CellGrid::around(dvec3(0), dvec3(3e4, 200, 3e4), 1).size, 1);
    EXPECT_EQ(CellGrid::around(dvec3(0), dvec3(2e3, 30, 2e3), 1).size, 1);
}

}  // namespace
}  // namespace vesper::test::cell_grid_test
