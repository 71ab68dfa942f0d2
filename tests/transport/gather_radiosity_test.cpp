// What takes part in light between surfaces: what moves, covers, hides, or is broken. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "support/gathered.h"
#include "support/rooms.h"

namespace vesper::test::gather_radiosity_test {
namespace {

using glm::dvec3, glm::vec3, transport::Radiosity;

constexpr double kPi = std::numbers::pi;
const dvec3 kUp(0, 1, 0);

/// A floor with a wall on it that glows, a lamp and a box.
scene::Scene yard() {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0.4f), 8);
    add_rectangle(scene, add_material(scene, 0.5f, 20), {-5, 0, 4}, {0, 0, -8}, {0, 3, 0});
    add_box(scene, 0, {1, 0.5f, 0.5f}, {2, 0.5f, 1});
    add_lamp(scene, 400, {3, 3, -2});
    return scene;
}

void expect_same(const Radiosity& a, const Radiosity& b) {
    EXPECT_EQ(a.grid.origin, b.grid.origin);
    EXPECT_EQ(a.grid.size, b.grid.size);
    EXPECT_EQ(a.numbers, b.numbers);
    EXPECT_EQ(a.heights, b.heights);
    EXPECT_EQ(a.areas, b.areas);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.reflectances, b.reflectances);
    EXPECT_EQ(a.sky, b.sky);
    EXPECT_EQ(a.first_source, b.first_source);
    EXPECT_EQ(a.first_met, b.first_met);
    EXPECT_EQ(a.met, b.met);
    EXPECT_EQ(a.parts, b.parts);
    EXPECT_EQ(a.beside, b.beside);
    const auto same = [](const Radiosity::Source& x, const Radiosity::Source& y) {
        return x.node == y.node && x.lux == y.lux;
    };
    EXPECT_TRUE(std::ranges::equal(a.sources, b.sources, same));
}

TEST(GatherRadiosity, TheSameSceneGivesTheSame) {
    const scene::Scene scene = yard();
    const Radiosity radiosity = gathered(scene);
    expect_same(radiosity, gathered(scene));
    // And all parts belong together.
    const size_t cells = radiosity.cells();
    EXPECT_GT(cells, 256u);
    const auto unsorted = std::ranges::adjacent_find(radiosity.numbers, std::ranges::greater_equal{});
    EXPECT_TRUE(unsorted == radiosity.numbers.end());
    EXPECT_EQ(radiosity.first_met.size(), cells + 1);
    EXPECT_EQ(radiosity.first_met.back(), radiosity.met.size());
    EXPECT_EQ(radiosity.parts.size(), radiosity.met.size());
    EXPECT_EQ(radiosity.beside.size(), cells * Radiosity::kBeside);
    EXPECT_EQ(radiosity.first_source.size(), cells + 1);
    EXPECT_EQ(radiosity.first_source.back(), radiosity.sources.size());
    for (const uint32_t met : radiosity.met) EXPECT_LT(met, cells);
    for (uint32_t i = 0; i < cells; ++i) EXPECT_EQ(radiosity.find(radiosity.numbers[i]), i);
    const Radiosity::Solution lit = radiosity.solve({.sky = dvec3(1)});
    for (const std::vector<vec3>& values : {lit.lamps, lit.other})
        for (const vec3& light : values) EXPECT_TRUE(light.g >= 0 && std::isfinite(light.g));
}

TEST(GatherRadiosity, AreasAreThoseOfTheSurfaces) {
    const Radiosity radiosity = gathered(yard());
    std::array<double, transport::kFacings> areas{};
    for (size_t i = 0; i < radiosity.cells(); ++i)
        areas[radiosity.grid.facing(radiosity.numbers[i])] += double(radiosity.areas[i]);
    EXPECT_NEAR(areas[0], 8 * 3 + 1, 1e-3);
    EXPECT_NEAR(areas[1], 1, 1e-3);
    EXPECT_NEAR(areas[4], 2, 1e-3);
    EXPECT_NEAR(areas[5], 2, 1e-3);
    // The floor under the box is covered; a cell that has other places leaves it out.
    EXPECT_LE(areas[2], 16 * 16 + 2 + 1e-3);
    EXPECT_GE(areas[2], 16 * 16 - 0.01);
}

TEST(GatherRadiosity, ProgressIsToldAndEndsIt) {
    const scene::Scene scene = yard();
    const auto world = scene::world_transforms(scene, 0);
    double least = 2, most = -1;
    int calls = 0;
    const auto run = [&](int last) {
        calls = 0;
        return transport::gather_radiosity(scene, world, {}, {}, [&](double share) {
            least = std::min(least, share), most = std::max(most, share);
            return ++calls < last;
        });
    };
    EXPECT_TRUE(run(1'000'000));
    EXPECT_GT(calls, 1);
    EXPECT_GE(least, 0);
    EXPECT_LE(most, 1);
    EXPECT_GT(most, 0.7);
    EXPECT_FALSE(run(1));
    EXPECT_EQ(calls, 1);
}

TEST(GatherRadiosity, NothingGivesNoCells) {
    scene::Scene scene;
    EXPECT_EQ(gathered(scene).cells(), 0u);
    add_lamp(scene, 100, {0, 1, 0});
    const Radiosity radiosity = gathered(scene);
    EXPECT_EQ(radiosity.cells(), 0u);
    EXPECT_TRUE(radiosity.solve({.sky = dvec3(3)}).other.empty());
    EXPECT_EQ(radiosity.at({}, {0, 0, 0}, kUp), dvec3(0));
    scene::Scene clear;
    add_floor(clear, add_material(clear, 0.5f), 5);
    clear.materials[0].clear = true;
    EXPECT_EQ(gathered(clear).cells(), 0u) << "what is clear has no light of its own";
}

// An emitter and a roof: all that they do is gone, to the last bit.
TEST(GatherRadiosity, WhatMovesGivesGetsAndHidesNothing) {
    scene::Scene scene = yard();
    const Radiosity without = gathered(scene);
    const size_t still = scene.nodes.size();
    add_rectangle(scene, 1, {-2, 2, -2}, {4, 0, 0}, {0, 0, 4});
    add_box(scene, 0, {3, 0.2f, 3}, {0, 2.5f, 0});
    std::vector<bool> moving(scene.nodes.size(), false);
    std::fill(moving.begin() + std::ptrdiff_t(still), moving.end(), true);
    expect_same(without, gathered(scene, kMetreCells, moving));
    EXPECT_NE(without.numbers, gathered(scene).numbers);
}

// A strong lamp on a car: no shadow ray goes to it.
TEST(GatherRadiosity, AMovingLampTakesNoLooksFromOthers) {
    scene::Scene scene = yard();
    const Radiosity without = gathered(scene);
    add_lamp(scene, 1e5, {0, 2, 0});
    std::vector<bool> moving(scene.nodes.size(), false);
    moving.back() = true;
    expect_same(without, gathered(scene, kMetreCells, moving));
}

// And gives no light, for one.
TEST(GatherRadiosity, AMovingLampGivesNothing) {
    scene::Scene scene = yard();
    add_lamp(scene, 1e5, {0, 2, 0});
    std::vector<bool> moving(scene.nodes.size(), false);
    moving.back() = true;
    const auto last = uint32_t(scene.nodes.size() - 1);
    for (const Radiosity::Source& source : gathered(scene, kMetreCells, moving).sources)
        EXPECT_NE(source.node & ~Radiosity::kLamp, last);
}

// A spot lights some of a floor, and that a wall and a sloping board: their light differs by little from that of a
// hundred times the rays, and by less from cell to cell.
TEST(GatherRadiosity, WhatASpotLightsIsReflectedEvenly) {
    scene::Scene scene;
    const uint32_t grey = add_material(scene, 0.5f);
    add_floor(scene, grey, 20);
    add_rectangle(scene, grey, {-20, 0, -12}, {40, 0, 0}, {0, 10, 0});
    add_rectangle(scene, grey, {-6, 0.5f, -6}, {12, 0, 0}, {0, 2, -3.46f});
    add_lamp(scene, 2000, {0, 6, 2});
    scene.nodes.back().rotation = glm::angleAxis(-kPi / 2, dvec3(1, 0, 0));
    scene.lamps.back().kind = scene::Lamp::Kind::Spot, scene.lamps.back().outer_cone = float(kPi / 6);
    const Radiosity few = gathered(scene), many = gathered(scene, {.cell_size = 1, .rays = 3200, .fine_cells = 0});
    const std::vector<vec3> light = few.solve({.reflections = 1}).other, wanted = many.solve({.reflections = 1}).other;
    std::vector<double> ratios;
    for (size_t i = 0; i < light.size(); ++i)
        if (const std::optional<uint32_t> other = many.find(few.numbers[i]);
            other && !few.grid.is_air(few.numbers[i]) && few.grid.facing(few.numbers[i]) != 2 &&
            wanted[*other].g > 0.01f)
            ratios.push_back(double(light[i].g) / double(wanted[*other].g));
    ASSERT_GT(ratios.size(), 300u);
    double mean = 0, variance = 0;
    for (const double ratio : ratios) mean += ratio / double(ratios.size());
    for (const double ratio : ratios) variance += (ratio - 1) * (ratio - 1) / double(ratios.size());
    EXPECT_NEAR(mean, 1, 0.03);
    EXPECT_LT(std::sqrt(variance), 0.15);
}

// In the open over a wide black floor: from above the whole sky, from below nothing, from the side half, and slopes
// something between.
TEST(GatherRadiosity, TheAirOverAFloorLightsWhatMovesThere) {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0), 200);  // beyond it are 0.5 % of a side's light
    const Radiosity radiosity = gathered(scene, {.cell_size = 5, .rays = 512, .fine_cells = 0});
    const std::vector<vec3> light = radiosity.solve({.sky = dvec3(1 / kPi)}).other;
    for (const dvec3 point : {dvec3(0.3, 1, 2), dvec3(-3, 2, 5.5), dvec3(7, 2.5, -9)}) {
        const auto at = [&](dvec3 normal) { return radiosity.at(light, point, glm::normalize(normal)).g; };
        EXPECT_NEAR(at({0, 1, 0}), 1, 1e-6);
        EXPECT_NEAR(at({0, -1, 0}), 0, 0.02) << "of what is beyond the floor";
        for (const dvec3 side : {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 0, 1), dvec3(0, 0, -1)}) {
            EXPECT_NEAR(at(side), 0.5, 0.03) << "of eight times 512 rays";
            EXPECT_NEAR(at(side + 0.98 * kUp), 0.745, 0.02);
            EXPECT_NEAR(at(side - 0.98 * kUp), 0.255, 0.03);
        }
    }
    EXPECT_EQ(radiosity.at(light, {0, 300, 0}, kUp), dvec3(0)) << "beyond the grid";
}

// Air is there only over ground, as high as it is open. 10 %: looks at walls that are near.
TEST(GatherRadiosity, TheAirOfARoomIsThatOfTheRoom) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f, 3), {4, 1.2f, 4});
    const Radiosity radiosity = gathered(scene);
    const std::vector<vec3> light = radiosity.solve({.sky = dvec3(1e5), .reflections = 40}).other;
    for (const dvec3 normal : {dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(0, 1, 0), dvec3(0, 0, -1)})
        EXPECT_NEAR(radiosity.at(light, {1, -0.1, -2}, normal).g / (kPi * 3 / 0.5), 1, 0.1);
}

// A ceiling that shows its back has no places of its own; rays find it, and it reflects what it gets.
TEST(GatherRadiosity, BacksAreFoundByRays) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), {3, 2, 3});
    scene::Primitive& ceiling = scene.meshes[1].primitives[0];
    ceiling.indices = {0, 2, 1, 0, 3, 2};
    for (scene::Vertex& vertex : ceiling.vertices) vertex.normal = -vertex.normal;
    add_lamp(scene, 100, {0.4, 0.3, 0});
    const Radiosity radiosity = gathered(scene);
    const Radiosity::Solution light = radiosity.solve({.reflections = 1});
    for (size_t i = 0; i < radiosity.cells(); ++i) {
        if (radiosity.grid.is_air(radiosity.numbers[i]) || radiosity.grid.middle(radiosity.numbers[i]).y >= 2) continue;
        EXPECT_EQ(radiosity.sky[i], 0);
        double parts = 0;
        for (uint32_t k = radiosity.first_met[i]; k < radiosity.first_met[i + 1]; ++k)
            parts += double(Radiosity::kPartUnit * glm::unpackHalf1x16(radiosity.parts[k]));
        EXPECT_NEAR(parts, 1, 1e-3) << i;
    }
    // 1.7 m over the lamp, where it faces down; less, as a cell is a mean over 1 m.
    EXPECT_NEAR(radiosity.at(light.lamps, {0.4, 2, 0}, -kUp).g, 100 / (1.7 * 1.7), 0.3 * 100 / (1.7 * 1.7));
}

// Beside an ordinary floor: triangles with corners that are no places change nothing, whichever corner it is.
// cos^1000 away from the axis: denormal numbers, of which no sum is even steps.
TEST(GatherRadiosity, ABeamThatGivesNextToNothingEnds) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0.5f), {-40, 0, 40}, {80, 0, 0}, {0, 0, -80});
    add_lamp(scene, 1000, {0, 4, 0});
    scene.lamps[0].kind = scene::Lamp::Kind::CosinePower, scene.lamps[0].exponent = 1000;
    const transport::Radiosity radiosity = gathered(scene, {.cell_size = 4, .fine_cells = 0});
    EXPECT_GT(radiosity.cells(), 300u);
}

// A lamp, a room and a panel below one group: the room is no housing, and the panel emits.
TEST(GatherRadiosity, ARoomIsNoHousingOfItsLamp) {
    scene::Scene scene;
    const uint32_t white = add_material(scene, 0.5f), glow = add_material(scene, 0, 100);
    scene.nodes.emplace_back();
    add_room(scene, white, glm::vec3(3));
    add_rectangle(scene, glow, {-1, 2.9f, -1}, {2, 0, 0}, {0, 0, 2});
    add_lamp(scene, 100, {0, 0, 0});
    for (size_t node = 1; node < scene.nodes.size(); ++node) scene.nodes[node].parent = 0;
    scene.nodes.back().fixture.reset();
    const transport::Radiosity radiosity = gathered(scene);
    const auto floor = [&](size_t i, dvec3 middle) {
        return radiosity.grid.facing(radiosity.numbers[i]) == 2 && middle.y < -2;
    };
    const auto light = radiosity.solve({.reflections = 0});
    EXPECT_GT(mean_over(radiosity, lux(light.lamps), floor), 3);
    EXPECT_GT(mean_over(radiosity, lux(light.other), floor), 5);
}

TEST(GatherRadiosity, BrokenTrianglesChangeNothing) {
    scene::Scene scene = yard();
    const Radiosity whole = gathered(scene);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, inf, 1e30f, -3e38f, 2e8f})
        for (size_t corner = 0; corner < 3; ++corner) {
            scene::Scene broken = scene;
            add_rectangle(broken, 0, {1, 1, 1}, {1, 0, 0}, {0, 1, 0});
            scene::Primitive& p = broken.meshes.back().primitives[0];
            p.indices = {0, 1, 2};
            p.vertices[corner].position.y = bad;
            const Radiosity radiosity = gathered(broken);
            EXPECT_EQ(radiosity.grid.size, whole.grid.size) << bad << " at corner " << corner;
            EXPECT_EQ(radiosity.numbers.size(), whole.numbers.size()) << bad << " at corner " << corner;
        }
}

// Cells grow with the area, and with the space where numbers would not fit.
TEST(GatherRadiosity, TheNumberOfCellsIsBounded) {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0.5f), 5000);
    const Radiosity wide = gathered(scene, {.cell_size = 1, .most_cells = 5'000});
    size_t floors = 0;
    double area = 0;
    for (const uint32_t number : wide.numbers) floors += !wide.grid.is_air(number);
    for (const float of_cell : wide.areas) area += double(of_cell);
    EXPECT_NEAR(area, 1e8, 100) << "however triangles are parted";
    EXPECT_LE(floors, 5'000u * 5 / 4) << "roughly: those along borders are halves";
    EXPECT_GE(floors, 2'000u);
    EXPECT_NEAR(wide.at(wide.solve({.sky = dvec3(1)}).other, {100, 0, -1234}, kUp).g, kPi, 1e-5);

    scene::Scene far = yard();
    add_rectangle(far, 0, {5e7f, 3e7f, -5e7f}, {8, 0, 0}, {0, 8, 0});
    EXPECT_GT(gathered(far).cells(), 0u);
}

// Nodes without extent, and turned inside out.
TEST(GatherRadiosity, ScalesOfNodesKeepFrontsAndAreas) {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0.5f), 4);
    scene.nodes[0].scale = {2, 1, -1};
    scene.nodes[0].translation = {100, 3, 0};
    add_rectangle(scene, 0, {0, 3, 0}, {1, 0, 0}, {0, 1, 0});
    scene.nodes[1].scale = {0, 0, 0};
    const Radiosity radiosity = gathered(scene);
    const std::vector<vec3> light = radiosity.solve({.sky = dvec3(1)}).other;
    double area = 0;
    for (const float of_cell : radiosity.areas) area += double(of_cell);
    EXPECT_NEAR(area, 16 * 8, 1e-3);
    EXPECT_NEAR(radiosity.at(light, {106, 3, 2}, kUp).g, kPi, 1e-5);
}

}  // namespace
}  // namespace vesper::test::gather_radiosity_test
