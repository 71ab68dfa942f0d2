// Cells that a wall or a slab goes through. SPDX-License-Identifier: MIT
#include "transport/cut_cells.h"

#include <gtest/gtest.h>

#include "support/gathered.h"
#include "support/rooms.h"
#include "transport/light_tracer.h"

namespace vesper::test::cut_cells_test {
namespace {

using glm::dvec3, transport::CellCut, transport::Radiosity;

const dvec3 kUp(0, 1, 0);

TEST(CellCut, HasPointsOnItsSide) {
    EXPECT_TRUE(CellCut().has({0.1, 0.9, 0.5}, 0));
    EXPECT_FALSE(CellCut().any());
    // Of cells that face +x or -x the first way is y, the second z; of +y: z and x.
    const CellCut lower = CellCut::across(0, 0.25, true), upper = CellCut::across(1, 0.75, false);
    for (const uint32_t side : {0u, 1u}) {
        EXPECT_TRUE(lower.has({0, 0.2, 0.9}, side) && lower.has({0, -3, 0.9}, side));
        EXPECT_FALSE(lower.has({0, 0.3, 0}, side) || lower.has({0, 1.5, 0}, side));
        EXPECT_TRUE(upper.has({0, 0, 0.8}, side) && upper.has({0, 0, 1.8}, side));
        EXPECT_FALSE(upper.has({0, 0, 0.7}, side));
    }
    EXPECT_TRUE(lower.has({0.9, 0.9, 0.2}, 2) && upper.has({0.8, 0, 0}, 2));
    EXPECT_FALSE(lower.has({0, 0, 0.3}, 2) || upper.has({0.7, 1, 1}, 2));
    // Within a step of 1/32, at the ends as well.
    for (double at = 0; at <= 1; at += 0.01) {
        EXPECT_TRUE(CellCut::across(0, at, true).has({0, at - 0.035, 0}, 0)) << at;
        EXPECT_FALSE(CellCut::across(0, at, true).has({0, at + 0.035, 0}, 0)) << at;
    }
}

TEST(CellCut, GoesAlongDiagonals) {
    // On +x y and z; through the middle of the cube, and 0.3 of its side from there.
    const CellCut both = CellCut::across(2, 0.5, true), apart = CellCut::across(3, 0.8, false);
    EXPECT_TRUE(both.has({0, 0.2, 0.7}, 0) && both.has({0, 0.7, 0.2}, 0));
    EXPECT_FALSE(both.has({0, 0.4, 0.7}, 0) || both.has({0, 0.7, 0.4}, 0));
    EXPECT_TRUE(apart.has({0, 0.75, 0.25}, 0));
    EXPECT_FALSE(apart.has({0, 0.65, 0.35}, 0) || apart.has({0, 0.25, 0.75}, 0));
    for (uint32_t way = 0; way < CellCut::kWays; ++way)
        for (uint32_t side = 0; side < transport::kFacings; ++side) {
            EXPECT_NEAR(glm::length(CellCut::direction(way, side)), 1, 1e-15);
            EXPECT_EQ(CellCut::direction(way, side)[transport::axis_of(side)], 0);
            EXPECT_TRUE(CellCut::across(way, 0, false).any());
        }
}

// To the cubes where the point lies, from the middle of its own, on the way beyond the plane.
TEST(CellCut, PointsBeyondGoToTheCubesThere) {
    EXPECT_EQ(CellCut::across(0, 0.6, true).beyond({0, 0.8, 0.9}, 0), dvec3(0, 1, 0));
    EXPECT_EQ(CellCut::across(1, 0.3, false).beyond({0, 0.8, 0.1}, 0), dvec3(0, 0, -1));
    EXPECT_EQ(CellCut::across(2, 0.6, true).beyond({0, 0.8, 0.9}, 0), dvec3(0, 1, 1));
    EXPECT_EQ(CellCut::across(2, 0.6, true).beyond({0, 0.9, 0.4}, 0), dvec3(0, 1, 0));
    EXPECT_EQ(CellCut::across(3, 0.3, false).beyond({0, 0.1, 0.9}, 0), dvec3(0, -1, 1));
    EXPECT_EQ(CellCut::across(0, 0.4, true).beyond({0, 0.45, 0.5}, 0), dvec3(0)) << "before the middle";
}

/// A wall, 8 m high, that faces +x, whose cubes have borders at halves of metres.
scene::Scene wall() {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0.5f), {0, 0, 4}, {0, 0, -8}, {0, 8, 0});
    return scene;
}

// Eight places in the cube of a point, or the first few; below 0.5 of its height they have half the reflectance.
transport::CellPlaces cut_at(const scene::Scene& scene, dvec3 point, uint32_t count = 8) {
    const auto world = scene::world_transforms(scene, 0);
    const rays::RayCaster rays(scene, world);
    const transport::CellGrid grid{.origin = {-0.5, -0.5, -4.5}, .size = 1, .count = {8, 9, 9}};
    const uint32_t number = grid.cell_at(point, {1, 0, 0}).value();
    transport::CellPlaces cell;
    for (const double y : {0.1, 0.35, 0.65, 0.9})
        for (const double z : {0.3, 0.7})
            if (cell.count() < count)
                add_place(cell, grid, number,
                          {dvec3(0, std::floor(point.y + 0.5) - 0.5 + y, std::floor(point.z + 0.5) - 0.5 + z),
                           {1, 0, 0},
                           dvec3(y < 0.5 ? 0.25 : 0.5),
                           0,
                           1,
                           0.125,
                           transport::Exposure::Open});
    transport::cut(cell, number, grid, rays);
    return cell;
}

TEST(CutCells, ASlabCutsTheCellsThatItMeets) {
    scene::Scene scene = wall();
    add_box(scene, 0, {0.5f, 0.05f, 4}, {0.5f, 3.0f - 0.25f, 0});  // 2.7 to 2.8 m: at 0.25 of a cube
    const transport::CellPlaces cell = cut_at(scene, {0, 3, 0});
    ASSERT_TRUE(cell.cut.any());
    EXPECT_EQ(cell.count(), 6u) << "the upper part is the larger";
    for (uint32_t k = 0; k < cell.count(); ++k) EXPECT_GT(cell.places[k].point.y, -0.2f);
    EXPECT_TRUE(cell.cut.has({0.5, 0.3, 0.5}, 0));
    EXPECT_FALSE(cell.cut.has({0.5, 0.2, 0.5}, 0));
    EXPECT_FALSE(cut_at(scene, {0, 2, 0}).cut.any());
    EXPECT_FALSE(cut_at(scene, {0, 4, 0}).cut.any());
}

TEST(CutCells, WhatIsBeyondTheCutCountsForNothing) {
    scene::Scene scene = wall();
    add_box(scene, 0, {0.5f, 0.05f, 4}, {0.5f, 3.0f, 0});  // through the middle
    const transport::CellPlaces cell = cut_at(scene, {0, 3, 0});
    ASSERT_EQ(cell.count(), 4u);
    EXPECT_EQ(cell.weight, 4);
    EXPECT_NEAR(cell.area, 0.5, 1e-12);
    const bool below = cell.cut.has({0, 0.1, 0}, 0);
    EXPECT_NEAR(cell.reflectance.g / cell.weight, below ? 0.25 : 0.5, 0.005);
    EXPECT_NEAR(cell.point.y / cell.weight, below ? -0.275 : 0.275, 1e-6);
    EXPECT_NEAR(cell.normal.x / cell.weight, 1, 1e-6);
}

TEST(CutCells, ThickSlabsCutThemToo) {
    for (const float half : {0.001f, 0.05f, 0.1f, 0.14f}) {
        scene::Scene scene = wall();
        add_box(scene, 0, {0.5f, half, 4}, {0.5f, 3.0f, 0});
        EXPECT_EQ(cut_at(scene, {0, 3, 0}).count(), 4u) << half;
    }
}

// But for places so near the wall that its angle counts.
TEST(CutCells, WallsCutThemAtAnyAngle) {
    for (double degrees = 0; degrees < 180; degrees += 7.5) {
        const double turn = glm::radians(degrees);
        const glm::vec3 along(0, std::sin(turn), std::cos(turn)), across(0, std::cos(turn), -std::sin(turn));
        scene::Scene scene = wall();
        for (const float side : {-1.0f, 1.0f})
            add_rectangle(scene, 0, glm::vec3(0, 3, 0) + 0.04f * side * across - 2.0f * side * along, {1, 0, 0},
                          4.0f * side * along);
        const transport::CellPlaces cell = cut_at(scene, {0, 3, 0});
        ASSERT_TRUE(cell.cut.any()) << degrees;
        bool over = false, under = false;
        for (uint32_t k = 0; k < cell.count(); ++k) {
            const float from_wall = glm::dot(cell.places[k].point, across);
            over = over || from_wall > 0.1f, under = under || from_wall < -0.1f;
        }
        EXPECT_NE(over, under) << degrees;
        // Its plane is within 22.5° of the wall.
        EXPECT_GT(std::abs(glm::dot(dvec3(across), CellCut::direction(cell.cut.way(), 0))), 0.92) << degrees;
    }
}

// A post by a small plate, or a wall: that two places say little.
TEST(CutCells, CellsOfTwoPlacesAreNotCut) {
    scene::Scene scene = wall();
    add_box(scene, 0, {0.5f, 0.05f, 4}, {0.5f, 3.0f, 0});
    EXPECT_FALSE(cut_at(scene, {0, 3, 0}, 2).cut.any());
    EXPECT_TRUE(cut_at(scene, {0, 3, 0}, 3).cut.any());
}

// The corner of a room 2 cm beyond the cube, which diagonals reach.
TEST(CutCells, WallsBesideTheCubeCutNothing) {
    scene::Scene scene = wall();
    add_rectangle(scene, 0, {0, 3.52f, 4}, {0, 0, -8}, {1, 0, 0});
    EXPECT_FALSE(cut_at(scene, {0, 3, 0}).cut.any());
    add_rectangle(scene, 0, {0, 0, 0.52f}, {0, 8, 0}, {1, 0, 0});
    EXPECT_FALSE(cut_at(scene, {0, 3, 0}).cut.any());
}

TEST(CutCells, PlacesCountByTheirWeights) {
    transport::CellPlaces cell;
    const transport::CellGrid grid{.size = 1, .count = {4, 4, 4}};
    const uint32_t number = grid.cell_at({1.5, 1.5, 1.5}, {1, 0, 0}).value();
    for (const double weight : {3.0, 1.0, 4.0})
        add_place(cell, grid, number,
                  {{1.5, 1.5 + 0.1 * weight, 1.5},
                   {1, 0, 0},
                   dvec3(0.125 * weight),
                   0,
                   weight,
                   weight,
                   transport::Exposure::Open});
    cell.keep(0b011);
    EXPECT_EQ(cell.count(), 2u);
    EXPECT_EQ(cell.weight, 4);
    EXPECT_EQ(cell.area, 4);
    EXPECT_NEAR(cell.reflectance.g / cell.weight, 0.125 * (3 * 3 + 1) / 4, 0.002);
    EXPECT_NEAR(cell.point.y / cell.weight, (3 * 0.3 + 0.1) / 4, 1e-6);
}

TEST(CutCells, WallsBetweenHalfOfThePairsSplitThem) {
    const auto split = [](float half, float length) {
        scene::Scene scene = wall();
        add_box(scene, 0, {0.5f, half, length}, {0.5f, 3.0f, 0});
        const auto world = scene::world_transforms(scene, 0);
        const transport::CellGrid grid{.origin = {-0.5, -0.5, -4.5}, .size = 1, .count = {8, 9, 9}};
        const uint32_t number = grid.cell_at({0, 3, 0}, {1, 0, 0}).value();
        return transport::is_split(cut_at(wall(), {0, 3, 0}), number, grid, rays::RayCaster(scene, world));
    };
    EXPECT_TRUE(split(0.05f, 4));
    EXPECT_FALSE(split(0.05f, 0.1f)) << "a post";
    EXPECT_FALSE(split(0.001f, 0.01f));
}

TEST(CutCells, APierCutsThemBesideIt) {
    scene::Scene scene = wall();
    add_box(scene, 0, {0.5f, 4, 0.04f}, {0.5f, 4, 0.1f});  // at 0.6 of a cube: what is below it is larger
    const transport::CellPlaces cell = cut_at(scene, {0, 3, 0});
    EXPECT_EQ(cell.cut.way(), 1u);
    EXPECT_TRUE(cell.cut.has({0.5, 0.5, 0.5}, 0));
    EXPECT_FALSE(cell.cut.has({0.5, 0.5, 0.7}, 0));
}

TEST(CutCells, WhatDoesNotPartThemCutsNothing) {
    scene::Scene scene = wall();
    EXPECT_FALSE(cut_at(scene, {0, 3, 0}).cut.any());
    add_box(scene, 0, {0.5f, 0.05f, 0.1f}, {0.5f, 2.75f, -0.4f});  // a bracket, at the side
    EXPECT_FALSE(cut_at(scene, {0, 3, 0}).cut.any());
    add_box(scene, 0, {0.05f, 0.05f, 4}, {0.05f, 2.75f, 0});  // a moulding, 10 cm
    EXPECT_FALSE(cut_at(scene, {0, 3, 0}).cut.any());
}

// Two facades and a lit floor between: above a balcony one gets the light of the other, below it that of the floor, up
// to where it meets the wall.
TEST(CutCells, ABalconyKeepsItsShadow) {
    scene::Scene scene = wall();
    add_rectangle(scene, 0, {0, 0, 4}, {8, 0, 0}, {0, 0, -8});
    add_rectangle(scene, 0, {8, 0, -4}, {0, 0, 8}, {0, 8, 0});
    add_box(scene, 0, {0.6f, 0.05f, 4}, {0.6f, 3.2f, 0});
    add_lamp(scene, 2000, {1.5, 1, 0});
    const auto world = scene::world_transforms(scene, 0);
    const Radiosity radiosity = gathered(scene);
    const transport::LightTracer tracer(scene, world);
    const auto light = radiosity.solve({}).other;
    for (const double y : {2.3, 2.6, 2.9, 3.1, 3.3, 3.5, 3.8, 4.2}) {
        double found = 0, wanted = 0;
        for (double z = -2; z < 2.1; z += 0.5) {
            found += radiosity.at(light, {0, y, z}, {1, 0, 0}).g;
            const transport::Illuminance traced = tracer.at({1e-3, y, z}, {1, 0, 0}, {.paths = 2048, .lamp_rays = 1});
            wanted += traced.sum().g - traced[transport::Origin::Lamps].g;
        }
        // 5 to 25 cm over the balcony it hides up to half.
        EXPECT_NEAR(found / wanted, 1, y > 3.2 && y < 3.6 ? 0.8 : 0.3) << y;
    }
}

// Two closed rooms side by side, a wall between, one of them lit. Rays find no way through. The cells of floor and
// ceiling that the wall crosses are cut there, but for some of which few places were found: of the light in the middle
// of the lit room up to 0.06 are found beside the wall, one room further 0.005.
TEST(CutCells, LightThroughAWallStaysNearIt) {
    for (const float thick : {0.02f, 0.1f, 0.2f})
        for (const double degrees : {0, 15, 30, 45}) {
            scene::Scene scene;
            const uint32_t grey = add_material(scene, 0.7f);
            add_room(scene, grey, {3, 1.5f, 3});
            add_room(scene, grey, {3, 1.5f, 3}, {6 + thick, 0, 0});
            add_lamp(scene, 1000, {0, 1, 0});
            const glm::dmat3 turned = turn(scene, degrees);
            const Radiosity radiosity = gathered(scene);
            const Radiosity::Solution light = radiosity.solve({});
            const auto mean = [&](double x) {
                double sum = 0;
                for (double z = -2.5; z < 2.6; z += 0.25)
                    sum += radiosity.at(light.other, turned * dvec3(x, -1.5, z), kUp).g / 21;
                return sum;
            };
            const double bright = mean(0);
            EXPECT_GT(bright, 100);
            for (const double beyond : {0.15, 0.5, 1.0, 2.0, 5.0})
                EXPECT_LE(mean(3 + double(thick) + beyond), (beyond > 4 ? 0.006 : 0.08) * bright)
                    << beyond << " m beyond " << thick << " m at " << degrees;
        }
}

// A border of cubes lies in the wall: no light goes through it.
TEST(CutCells, AWallBetweenCubesPartsThem) {
    scene::Scene scene;
    const uint32_t grey = add_material(scene, 0.7f);
    add_room(scene, grey, {3, 1.5f, 3}, {0.45f, 0, 0});
    add_room(scene, grey, {3, 1.5f, 3}, {6.55f, 0, 0});
    add_rectangle(scene, grey, {-3, -1.5f, -3}, {0, 0, 1}, {0, 1, 0});  // so that the grid begins there
    add_lamp(scene, 1000, {0.45, 1, 0});
    const Radiosity radiosity = gathered(scene);
    const Radiosity::Solution light = radiosity.solve({});
    for (double x = 3.6; x < 9; x += 0.3)
        for (double z = -2.5; z < 2.6; z += 0.25) {
            EXPECT_EQ(radiosity.at(light.other, {x, -1.5, z}, kUp).g, 0) << x << " " << z;
            EXPECT_EQ(radiosity.at(light.lamps, {x, -1.5, z}, kUp).g, 0) << x << " " << z;
        }
}

}  // namespace
}  // namespace vesper::test::cut_cells_test
