// Cells' values at points of surfaces, of cells that are made up. SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/made_cells.h"
#include "transport/radiosity.h"

namespace vesper::test::radiosity_lookup_test {
namespace {

using glm::dvec3, glm::vec3, transport::kSides, transport::Radiosity;

const transport::CellGrid kGrid{.origin = {10, -20, 30}, .size = 2, .count = {9, 10, 11}};

/// A value at a point of the surface whose normal goes to a side, both in cubes.
dvec3 at(const MadeCells& made, dvec3 place, uint32_t side) {
    const std::vector<vec3> light = made.light();
    return made.radiosity().at(light, kGrid.origin + kGrid.size * place, transport::direction_of(side));
}

/// In the plane across a side: along it, and across it in two directions.
dvec3 placed(uint32_t side, double along, double u, double v) {
    const int axis = int(side / 2);
    dvec3 place(0);
    place[axis] = along, place[(axis + 1) % 3] = u, place[(axis + 2) % 3] = v;
    return place;
}

// Values of a plane are met exactly, but for the least weights: 1e-7 of each of four cells.
TEST(RadiosityAt, IsLinearBetweenCellsOfAllSides) {
    for (uint32_t side = 0; side < kSides; ++side) {
        MadeCells made{kGrid, {}};
        for (int u = 0; u < 9; ++u)
            for (int v = 0; v < 9; ++v)
                made.add(placed(side, 4, u, v), side, 0, {3 + 2 * u + 5 * v, 100 - u * 4, 7 * v});
        for (double u = 0.5; u < 8.5; u += 0.37)
            for (double v = 0.5; v < 8.5; v += 0.41) {
                const dvec3 found = at(made, placed(side, 4.5, u, v), side);
                EXPECT_NEAR(found.x, 3 + 2 * (u - 0.5) + 5 * (v - 0.5), 1e-5) << side << " at " << u << ", " << v;
                EXPECT_NEAR(found.y, 100 - 4 * (u - 0.5), 1e-5);
                EXPECT_NEAR(found.z, 7 * (v - 0.5), 1e-5);
            }
        EXPECT_EQ(at(made, placed(side, 4.5, 3, 3), side ^ 1u), dvec3(0)) << "other sides have none";
        EXPECT_EQ(at(made, placed(side, 4.5, 3, 3), (side + 2) % 6), dvec3(0));
    }
}

// Surfaces between two sides have cells of their own, which blend along the slope.
TEST(RadiosityAt, IsLinearOnSlopesBetweenSides) {
    for (uint32_t facing = kSides; facing < transport::kFacings; ++facing) {
        MadeCells made{kGrid, {}};
        const int axis = transport::axis_of(facing), second = (axis + 1) % 3, third = (axis + 2) % 3;
        const double slope = (facing - kSides) % 4 == 0 || (facing - kSides) % 4 == 3 ? -1 : 1;
        const auto on_slope = [&](double u, double v) {
            dvec3 place(0);
            place[axis] = slope < 0 ? 8 - u : u + 1, place[second] = u, place[third] = v;
            return place;
        };
        for (int u = 0; u < 8; ++u)
            for (int v = 0; v < 8; ++v) {
                dvec3 cube = on_slope(u, v);
                if (slope < 0) cube[axis] -= 1;
                made.add(cube, facing, 0, vec3(float(3 + 2 * u + 5 * v)));
            }
        for (double v = 0.5; v < 7.5; v += 0.41)
            for (double u = 1.5; u < 6.5; u += 1)
                EXPECT_NEAR(at(made, on_slope(u, v), facing).x, 3 + 2 * (u - 0.5) + 5 * (v - 0.5), 1e-4) << facing;
        EXPECT_EQ(at(made, on_slope(3, 3), uint32_t(2 * axis)), dvec3(0)) << "sides have others";
    }
}

// Beside the last cells there is nothing to blend with: their own value goes on.
TEST(RadiosityAt, GoesOnBesideTheLastCell) {
    MadeCells made{kGrid, {}};
    made.add({4, 4, 4}, 2, 0, vec3(6));
    for (const double x : {3.6, 4.0, 4.5, 4.99, 5.4}) EXPECT_NEAR(at(made, {x, 4.5, 4.7}, 2).x, 6, 1e-12) << x;
    EXPECT_EQ(at(made, {5.51, 4.5, 4.5}, 2), dvec3(0)) << "a cube away there is none";
    EXPECT_EQ(at(made, {4.5, 4.5, 2.9}, 2), dvec3(0));
}

// Halfway between two cells: of one whose plane is h cubes off 1 - h / 0.75 counts, at least 0.001.
TEST(RadiosityAt, SurfacesAtOtherHeightsCountLess) {
    for (uint32_t side = 0; side < kSides; ++side)
        for (const double off : {-0.5, -0.3, 0.0, 0.15, 0.3, 0.45}) {
            MadeCells made{kGrid, {}};
            made.add(placed(side, 4, 4, 4), side, 0, vec3(10));
            made.add(placed(side, 4, 5, 4), side, off * kGrid.size, vec3(20));
            const double weight = 1 - std::abs(off) / 0.75;
            EXPECT_NEAR(at(made, placed(side, 4.5, 5, 4.5), side).x, (10 + 20 * weight) / (1 + weight), 1e-5)
                << side << " by " << off;
        }
    // From the bottom of a cube, 0.95 cubes below the other surface.
    MadeCells made{kGrid, {}};
    made.add({4, 4, 4}, 2, -0.45 * kGrid.size, vec3(10)), made.add({5, 4, 4}, 2, 0.5 * kGrid.size, vec3(20));
    EXPECT_NEAR(at(made, {5, 4.05, 4.5}, 2).x, (10 + 20 * 0.001) / 1.001, 1e-5);
}

// A plane that slopes through cubes: its cells lie in more than one layer, and the values of a plane are met, as at no
// place the cells of the plane are left out. Where a plane leaves a cube near its corner there may be no cell.
TEST(RadiosityAt, IsContinuousOnSlopes) {
    for (const dvec3 slope : {dvec3(0, 1, 1), dvec3(0.3, 1, -0.9), dvec3(-0.5, 1, 0.2), dvec3(0.1, 1, -0.6)}) {
        const dvec3 normal = glm::normalize(slope);
        MadeCells made{kGrid, {}};
        const auto value = [](dvec3 place) { return 50 + 3 * place.x - 2 * place.z; };
        for (int x = 0; x < 9; ++x)
            for (int y = 0; y < 10; ++y)
                for (int z = 0; z < 11; ++z) {
                    const dvec3 middle(x + 0.5, y + 0.5, z + 0.5);
                    const double height = glm::dot(normal, dvec3(4.5, 5, 5.5) - middle);  // cubes
                    if (std::abs(height) < 0.6)
                        made.add({x, y, z}, transport::facing_of(normal), vec3(normal), height * kGrid.size,
                                 vec3(float(value(middle + height * normal))));
                }
        const std::vector<vec3> light = made.light();
        const Radiosity radiosity = made.radiosity();
        double before = 0;
        for (double z = 4; z < 7; z += 0.01) {
            const double x = 4.2 + 0.1 * z;
            const dvec3 place(x, 5 - (slope.x * (x - 4.5) + slope.z * (z - 5.5)), z);
            const double found = radiosity.at(light, kGrid.origin + kGrid.size * place, normal).x;
            EXPECT_NEAR(found, value(place), 1) << z;
            EXPECT_NEAR(found, before > 0 ? before : found, 0.1) << z << ": a step";
            before = found;
        }
    }
}

// The air: linear between eight cubes, by the squares of the normal's components. Where a surface is near it counts
// alone.
TEST(RadiosityAt, TheAirIsThereWhereNoSurfaceIs) {
    MadeCells made{kGrid, {}};
    const auto value = [](dvec3 cube, uint32_t side) {
        return float(1 + cube.x + 10 * cube.y + 100 * cube.z + 1000 * side);
    };
    for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y)
            for (int z = 0; z < 3; ++z)
                for (uint32_t side = 0; side < kSides; ++side)
                    made.add_air({x, y, z}, side, vec3(value({x, y, z}, side)));
    made.add({4, 1, 4}, 2, 0, vec3(5));
    const std::vector<vec3> light = made.light();
    const Radiosity radiosity = made.radiosity();
    for (const dvec3 place : {dvec3(4.5, 5.5, 4.5), dvec3(2.1, 7, 8.3), dvec3(8, 2.5, 6), dvec3(6, 6, 6)})
        for (const dvec3 normal : {dvec3(0, 1, 0), dvec3(0, 0, -2), dvec3(1, -2, 2), dvec3(-0.3, 0.1, 0.05)}) {
            double want = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const uint32_t side = uint32_t(2 * axis + (normal[axis] < 0));
                const double part = normal[axis] * normal[axis] / glm::dot(normal, normal);
                want += part * double(value(place / 4.0 - 0.5, side));
            }
            // Floats of some 1e3; and 1e-7 of each of eight.
            EXPECT_NEAR(radiosity.at(light, kGrid.origin + kGrid.size * place, normal).x, want, 1e-3) << place.x;
        }
    EXPECT_NEAR(at(made, {4.5, 1.5, 4.5}, 2).x, 5, 1e-9);
    EXPECT_NEAR(at(made, {4.5, 1.9, 4.5}, 2).x, 5, 1e-9) << "0.4 cubes over it";
    EXPECT_GT(at(made, {4.5, 2.4, 4.5}, 2).x, 1000) << "0.9 over it, in a cube of its own";
    EXPECT_GT(at(made, {4.5, 1.5, 4.5}, 3).x, 1000) << "its back";
}

// Another surface in the cube, where there is no air either: better than none.
TEST(RadiosityAt, WithoutAirTheNearestSurfaceCounts) {
    MadeCells made{kGrid, {}};
    made.add({4, 4, 4}, 2, 0.45 * kGrid.size, vec3(8));
    EXPECT_NEAR(at(made, {4.5, 4.05, 4.5}, 2).x, 8, 1e-9);
}

TEST(RadiosityAt, BeyondTheGridThereIsNoLight) {
    MadeCells made{kGrid, {}};
    for (int u = 0; u < 9; ++u)
        for (int v = 0; v < 11; ++v) made.add({u, 9, v}, 2, 0, vec3(1));
    made.add_air({0, 0, 0}, 2, vec3(1));
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const double far : {-1e3, 1e3, 1e30, -inf, inf, nan})
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 place(4.5, 9.5, 4.5);
            place[axis] = far;
            EXPECT_EQ(at(made, place, 2), dvec3(0)) << far << " along " << axis;
        }
    EXPECT_EQ(Radiosity{}.at({}, {0, 0, 0}, {0, 1, 0}), dvec3(0));
}

}  // namespace
}  // namespace vesper::test::radiosity_lookup_test
