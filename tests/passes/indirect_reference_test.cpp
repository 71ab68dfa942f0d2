// The reference of light from cells: what it is where that is known, and the lookup on the host.
// SPDX-License-Identifier: MIT
#include "passes/indirect_reference.h"

#include <algorithm>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "support/made_cells.h"
#include "support/noise.h"

namespace vesper::test::indirect_reference_test {
namespace {

using glm::dvec3;

const transport::CellGrid kGrid{.origin = {-4, 50, 9}, .size = 0.5, .count = {12, 9, 10}};

reference::CellList listed(const MadeCells& made) {
    std::vector<reference::LitCell> cells;
    for (const auto& [number, cell] : made.cells) {
        cells.push_back({number, dvec3(cell.light), double(cell.height), dvec3(cell.normal), cell.walls});
        reference::set_cut(cells.back(), cell.cut.bits);
    }
    return {made.grid, cells};
}

TEST(IndirectReference, AFloorOfOneValueHasIt) {
    MadeCells made{kGrid, {}};
    for (int x = 0; x < 12; ++x)
        for (int z = 0; z < 10; ++z) made.add({x, 3, z}, 2, 0.1, {3, 4, 5});
    const reference::CellList cells = listed(made);
    for (const dvec3 place : {dvec3(0.1, 3.2, 0.2), dvec3(6, 3.7, 5), dvec3(11.9, 3.9, 9.9)}) {
        const dvec3 light = reference::illuminance_on(cells, place, {0, 1, 0}, 2);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], 3 + c, 1e-12);
    }
    EXPECT_EQ(reference::illuminance_on(cells, {6, 3.5, 5}, {0, -1, 0}, 3), dvec3(0));
    EXPECT_EQ(reference::illuminance_on(cells, {6, 5.5, 5}, {0, 1, 0}, 2), dvec3(0));
    EXPECT_EQ(reference::illuminance_on(cells, {-2, 3.5, 5}, {0, 1, 0}, 2), dvec3(0));
}

TEST(IndirectReference, WhereThereAreNoCellsTheSkyIsOpen) {
    const reference::CellList none(kGrid, {}, {8, 4, 2}, {0, 4, 1});
    const auto at = [&](dvec3 normal) { return reference::illuminance_on(none, {6, 5, 5}, normal, 2); };
    EXPECT_EQ(at({0, 1, 0}), dvec3(8, 4, 2));
    EXPECT_EQ(at({0, -1, 0}), dvec3(0, 4, 1));
    EXPECT_EQ(at({0, 0, 1}), dvec3(4, 4, 1.5));
    EXPECT_NEAR(at({0.8, 0.6, 0}).x, 6.4, 1e-12);
}

// A quarter of the way from one cell to the next, which is 0.3 cubes higher: weights 3 to 1 * 0.6.
TEST(IndirectReference, HeightsAndDistancesAreWeights) {
    MadeCells made{kGrid, {}};
    made.add({4, 3, 4}, 2, 0, glm::vec3(1)), made.add({5, 3, 4}, 2, 0.15, glm::vec3(2));
    const double found = reference::illuminance_on(listed(made), {4.75, 3.5, 4.5}, {0, 1, 0}, 2).x;
    EXPECT_NEAR(found, (0.75 + 2 * 0.25 * 0.6) / (0.75 + 0.25 * 0.6), 1e-6);  // least weights are 1e-7
}

// On the ground (+y) the eight around a cell are counted by z, and then by x.
TEST(IndirectReference, NoLightCrossesAWall) {
    const auto light_at = [](uint8_t walls, dvec3 place) {
        MadeCells made{kGrid, {}};
        made.add({4, 3, 4}, 2, 0, glm::vec3(1), walls), made.add({5, 3, 4}, 2, 0, glm::vec3(24));
        made.add({4, 3, 5}, 2, 0, glm::vec3(7)), made.add({5, 3, 5}, 2, 0, glm::vec3(100));
        return reference::illuminance_on(listed(made), place, {0, 1, 0}, 2).x;
    };
    const dvec3 by_x(4.75, 3.5, 4.5), by_z(4.5, 3.5, 4.75), by_both(4.75, 3.5, 4.75);
    EXPECT_NEAR(light_at(0, by_x), 0.75 + 0.25 * 24, 1e-4);
    EXPECT_NEAR(light_at(1 << 6, by_x), 1, 1e-4) << "x + 1";
    EXPECT_NEAR(light_at(1 << 6, by_z), 0.75 + 0.25 * 7, 1e-4);
    EXPECT_NEAR(light_at(1 << 4, by_z), 1, 1e-4) << "z + 1";
    EXPECT_NEAR(light_at(1 << 4, by_x), 0.75 + 0.25 * 24, 1e-4);
    EXPECT_NEAR(light_at(1 << 7, by_both), (9 + 3 * 24 + 3 * 7) / 15.0, 1e-4) << "the corner";
    // Seen from the other column it is not the wall of this one.
    EXPECT_NEAR(light_at(1 << 6, {5.25, 3.5, 4.5}), 0.25 + 0.75 * 24, 1e-4);
}

// A wall of a facade (+x) that a slab at a third of its cube's height parts: below the slab there is the light of the
// cube below, above it none of that. On +x the eight around a cell are counted by y first.
TEST(IndirectReference, ACutPartsACell) {
    const auto light_at = [](double height, uint8_t walls_below) {
        MadeCells made{kGrid, {}};
        const uint32_t kSide = 0;
        made.add({4, 3, 4}, kSide, {1, 0, 0}, 0, glm::vec3(1), walls_below);
        made.add({4, 4, 4}, kSide, {1, 0, 0}, 0, glm::vec3(8), 0, transport::CellCut::across(0, 1 / 3.0, false));
        made.add({4, 5, 4}, kSide, {1, 0, 0}, 0, glm::vec3(8));
        return reference::illuminance_on(listed(made), {4.5, height, 4.5}, {1, 0, 0}, kSide).x;
    };
    for (const double below : {3.6, 3.9, 4.1, 4.3}) EXPECT_NEAR(light_at(below, 0), 1, 1e-4) << below;
    // Above it, the cube below counts unless it is hidden: that is for the cell to say.
    EXPECT_NEAR(light_at(4.4, 0), 0.1 * 1 + 0.9 * 8, 1e-4);
    for (const double above : {4.4, 4.9, 5.2}) EXPECT_GT(light_at(above, 1 << 4), 7) << above;
}

// A wall of a facade (+x; y, then z) that another meets at 45°: beyond it there is the light of the cube where the
// point lies, of two beside this one the nearer.
TEST(IndirectReference, ACutPartsACellAlongADiagonal) {
    MadeCells made{kGrid, {}};
    const uint32_t kSide = 0;
    made.add({4, 4, 4}, kSide, {1, 0, 0}, 0, glm::vec3(8), 0, transport::CellCut::across(2, 0.6, true));
    for (const auto& [y, z, light] : {std::array{5, 4, 1}, std::array{4, 5, 2}, std::array{5, 5, 4}})
        made.add({4, y, z}, kSide, {1, 0, 0}, 0, glm::vec3(float(light)), y == 4 ? 1 << 1 : 0);
    const auto at = [&](double y, double z) {
        return reference::illuminance_on(listed(made), {4.5, y, z}, {1, 0, 0}, kSide).x;
    };
    EXPECT_NEAR(at(4.5, 4.5), 8, 1e-4);
    EXPECT_NEAR(at(4.6, 4.6), 0.01 / 0.19 * 4 + 0.09 / 0.19 * 3, 1e-3) << "just beyond: of the other three";
    EXPECT_NEAR(at(4.9, 4.9), (0.16 * 4 + 0.24 * 3) / 0.64, 1e-3);
    // Where z alone is beyond, the cube at z says what is seen: not the one below it, nor this one.
    EXPECT_NEAR(at(4.45, 4.95), 2, 1e-4);
}

TEST(IndirectReference, OfTheAirSidesCountByTheSquaresOfTheNormal) {
    MadeCells made{kGrid, {}};
    for (uint32_t side = 0; side < 6; ++side) made.add_air({0, 0, 0}, side, glm::vec3(std::exp2(float(side))));
    const reference::CellList cells = listed(made);
    const dvec3 normal = dvec3(1, -2, 2) / 3.0;  // +x, -y, +z
    EXPECT_NEAR(reference::illuminance_on(cells, {6.5, 5.2, 7}, normal, 3).x, (1 + 4 * 8 + 4 * 16) / 9.0, 1e-12);
}

TEST(IndirectReference, APixelSendsWhatItsSurfaceReflects) {
    MadeCells made{{.origin = {-10.5, -3, -10.5}, .size = 1, .count = {21, 2, 21}}, {}};
    for (int x = 0; x < 21; ++x)
        for (int z = 0; z < 21; ++z) made.add({x, 0, z}, 2, 0, {10, 20, 40});
    const reference::CellList cells = listed(made);
    const gpu_scene::View view = gpu_scene::View::symmetric({8, 8}, 1, glm::dmat4(1));
    // Below the eye, 2.5 m at a depth of 6 m: pixel (x, y) with a slope of -2.5 / 6.
    const glm::dvec2 pixel(4, (-2.5 / 6 - double(view.ray_offset().y)) / double(view.ray_scale().y));
    reference::SurfaceTexel texel{{0.5, 0.25, 1, 0}, {reference::octahedral_encode({0, 1, 0}), 6, 1}, dvec3(0)};
    const dvec3 found = reference::add_indirect(cells, texel, {1, 2, 3}, pixel, view, 1 / std::numbers::pi);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], 1 + c + (c == 0 ? 5 : c == 1 ? 5 : 40) / std::numbers::pi, 1e-6) << c;
    texel.reflectance.w = double(shared::kRoadKind), texel.surface.w = -0.5;
    const dvec3 road = reference::add_indirect(cells, texel, dvec3(0), pixel, view, 1 / std::numbers::pi);
    EXPECT_NEAR(road.x, 5 / std::numbers::pi * reference::road_in_diffuse(0.5, 2.5 / 6.5), 1e-6);
    texel.surface.z = 0;
    EXPECT_EQ(reference::add_indirect(cells, texel, {1, 2, 3}, pixel, view, 1), dvec3(1, 2, 3)) << "sky";
}

TEST(IndirectReference, OfKnownIlluminanceAPixelSendsRhoEOverPi) {
    const gpu_scene::View view = gpu_scene::View::symmetric({8, 8}, 1, glm::dmat4(1));
    reference::SurfaceTexel texel{{0.5, 0.25, 1, 0}, {reference::octahedral_encode({0, 0, 1}), 6, 1}, dvec3(0)};
    const dvec3 found = reference::add_illuminance(texel, {1, 2, 3}, {10, 20, 40}, {4, 4}, view, 1 / std::numbers::pi);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], 1 + c + (c < 2 ? 5 : 40) / std::numbers::pi, 1e-12) << c;
    texel.reflectance.w = double(shared::kRoadKind), texel.surface.w = -0.5;  // a road, seen from above
    EXPECT_NEAR(reference::add_illuminance(texel, dvec3(0), {10, 20, 40}, {4, 4}, view, 1).x, 2.5, 1e-12);
    texel.surface.z = 0;
    EXPECT_EQ(reference::add_illuminance(texel, {1, 2, 3}, {10, 20, 40}, {4, 4}, view, 1), dvec3(1, 2, 3)) << "sky";
}

// Cells of random planes, gaps among them; points in the grid and beside it.
TEST(IndirectReference, IsTheLookupOfTheHost) {
    Noise random(5);
    MadeCells made{kGrid, {}};
    const auto below = [&](int count) { return double(int(random.unit() * float(count))); };
    for (int i = 0; i < 1500; ++i)
        made.add({below(12), below(9), below(10)}, uint32_t(below(6)),
                 glm::normalize(glm::vec3(random.normal(), random.normal(), random.normal())),
                 0.5 * (double(random.unit()) - 0.5), {random.unit(), random.unit(), random.unit()},
                 uint8_t(below(256)) & uint8_t(below(256)),
                 i % 3 == 0 ? transport::CellCut::across(uint32_t(below(4)), double(random.unit()), below(2) > 0)
                            : transport::CellCut());
    for (int i = 0; i < 20; ++i)
        made.add_air({below(2), below(2), below(2)}, uint32_t(below(6)), glm::vec3(random.unit()));
    const reference::CellList cells = listed(made);
    const transport::Radiosity radiosity = made.radiosity();
    const std::vector<glm::vec3> light = made.light();
    size_t lit = 0;
    for (int i = 0; i < 20'000; ++i) {
        const dvec3 place = dvec3(random.unit(), random.unit(), random.unit()) * dvec3(14, 11, 12) - 1.0;
        const dvec3 normal = glm::normalize(dvec3(random.normal(), random.normal(), random.normal()));
        const dvec3 want = radiosity.at(light, kGrid.origin + kGrid.size * place, normal);
        const dvec3 found = reference::illuminance_on(cells, place, normal, reference::facings_of(normal)[0]);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c], want[c], 1e-6) << i;  // weights are floats there
        lit += want != dvec3(0);
    }
    EXPECT_GT(lit, 10'000u);
}

}  // namespace
}  // namespace vesper::test::indirect_reference_test
