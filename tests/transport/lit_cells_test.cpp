// Rays that are sent where lamps light something. SPDX-License-Identifier: MIT
#include "transport/lit_cells.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "transport/sampling.h"

namespace vesper::test::lit_cells_test {
namespace {

using glm::dvec3, transport::CellGrid, transport::LitCells, transport::Patch, transport::RayGuide;

constexpr double kPi = std::numbers::pi;
const CellGrid kGrid = CellGrid::around({-32, 0, -32}, {32, 16, 32}, 1);

Patch at(dvec3 point, dvec3 normal) {
    const transport::SurfacePlace place{point, normal, 0};
    return Patch::around({&place, 1});
}

/// Of the floor, `side` by `side` cells from a corner on.
std::vector<LitCells::Cell> lit_floor(dvec3 corner, int side) {
    std::vector<LitCells::Cell> cells;
    for (int i = 0; i < side * side; ++i) {
        const dvec3 place = corner + dvec3(i % side + 0.5, 0.01, i / side + 0.5);
        cells.push_back({*kGrid.cell_at(place, {0, 1, 0}), place, 10.0 + i});
    }
    std::ranges::sort(cells, {}, &LitCells::Cell::number);
    return cells;
}

// Three cones, two of which overlap: directions taken from it, each over its density, sum up to the solid angle of what
// they cover.
TEST(RayGuide, TakesDirectionsAsOftenAsItsDensitySays) {
    RayGuide guide;
    EXPECT_FALSE(guide.any());
    EXPECT_EQ(guide.density({0, 0, 1}), 0);
    guide.add({0, 0, 1}, 0.9, 3);
    guide.add(glm::normalize(dvec3(0.1, 0, 1)), 0.95, 1);
    guide.add({0, -1, 0}, 0.5, 2);
    transport::Random random(1);
    const transport::Lattice lattice(random);
    constexpr uint32_t kMany = 200000;
    double sum = 0, below = 0, covered = 0;
    for (uint32_t i = 0; i < kMany; ++i) {
        const dvec3 direction = guide.direction(lattice.at(i));
        ASSERT_NEAR(glm::length(direction), 1, 1e-12);
        const double density = guide.density(direction);
        ASSERT_GT(density, 0);
        sum += 1 / density, below += direction.y < -0.5 ? 1 : 0;
        const double z = 2 * lattice.at(i).x - 1, turn = 2 * kPi * lattice.at(i).y, r = std::sqrt(1 - z * z);
        covered += guide.density({r * std::cos(turn), r * std::sin(turn), z}) > 0 ? 4 * kPi / kMany : 0;
    }
    EXPECT_NEAR(below / kMany, 2.0 / 6, 1e-3);
    EXPECT_NEAR(sum / kMany, covered, 0.01);
    EXPECT_NEAR(guide.density({0, -1, 0}), 2.0 / 6 / (2 * kPi * 0.5), 1e-12);
}

// Near ones and far ones; a floor of so many that most are taken together.
TEST(LitCells, HaveRaysSentToAllThatIsLit) {
    std::vector<LitCells::Cell> cells = lit_floor({-20, 0, -20}, 30);
    const LitCells lit(kGrid, cells);
    for (const dvec3 point : {dvec3(-5, 3, 12), dvec3(20, 8, 20), dvec3(-8, 2, -8)}) {
        const dvec3 normal = glm::normalize(dvec3(-6, 0, -6) - point);
        const RayGuide guide = lit.guide(at(point, normal));
        ASSERT_TRUE(guide.any());
        for (const LitCells::Cell& cell : cells) {
            const dvec3 to = glm::normalize(cell.place - point);
            if (glm::dot(to, normal) < 0.05) continue;
            EXPECT_GT(guide.density(to), 0) << cell.place.x << ", " << cell.place.z;
        }
    }
}

TEST(LitCells, HaveNoRaysSentToWhatGivesNoLight) {
    EXPECT_FALSE(LitCells().guide(at({0, 1, 0}, {0, 1, 0})).any());
    EXPECT_FALSE(LitCells(kGrid, {}).guide(at({0, 1, 0}, {0, 1, 0})).any());
    const LitCells lit(kGrid, lit_floor({5, 0, 5}, 4));
    EXPECT_FALSE(lit.guide(at({7, 6, 7}, {0, 1, 0})).any()) << "it is below";
    EXPECT_FALSE(lit.guide(at({-20, 3, 7}, {-1, 0, 0})).any()) << "it is behind";
}

// The nearer of two alike, and the brighter of two as far.
TEST(LitCells, HaveMostRaysSentToWhatGivesMost) {
    std::vector<LitCells::Cell> cells = lit_floor({10, 0, 0}, 1), others = lit_floor({-11, 0, 0}, 1);
    others[0].flux = 3 * cells[0].flux;
    cells.push_back(others[0]);
    std::ranges::sort(cells, {}, &LitCells::Cell::number);
    const RayGuide guide = LitCells(kGrid, cells).guide(at({0, 5, 0.5}, {0, -1, 0}));
    const double right = guide.density(glm::normalize(dvec3(10.5, -4.99, 0))),
                 left = guide.density(glm::normalize(dvec3(-10.5, -4.99, 0)));
    EXPECT_NEAR(left / right, 3, 1e-6);
}

}  // namespace
}  // namespace vesper::test::lit_cells_test
