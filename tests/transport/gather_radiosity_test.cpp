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
#include "transport/cell_places.h"

namespace vesper::test::gather_radiosity_test {
namespace {

using glm::dvec3, glm::vec3, transport::Radiosity;

constexpr double kPi = std::numbers::pi;
const dvec3 kUp(0, 1, 0);

void add_floor(scene::Scene& scene, uint32_t material, float half) {
    add_rectangle(scene, material, {-half, 0, -half}, {0, 0, 2 * half}, {2 * half, 0, 0});
}

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
    std::array<double, transport::kSides> areas{};
    for (size_t i = 0; i < radiosity.cells(); ++i)
        areas[radiosity.grid.side(radiosity.numbers[i])] += double(radiosity.areas[i]);
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
    expect_same(without, gathered(scene, {}, moving));
    EXPECT_NE(without.numbers, gathered(scene).numbers);
}

// A strong lamp on a car: no shadow ray goes to it.
TEST(GatherRadiosity, AMovingLampTakesNoLooksFromOthers) {
    scene::Scene scene = yard();
    const Radiosity without = gathered(scene);
    add_lamp(scene, 1e5, {0, 2, 0});
    std::vector<bool> moving(scene.nodes.size(), false);
    moving.back() = true;
    expect_same(without, gathered(scene, {}, moving));
}

// And gives no light, for one.
TEST(GatherRadiosity, AMovingLampGivesNothing) {
    scene::Scene scene = yard();
    add_lamp(scene, 1e5, {0, 2, 0});
    std::vector<bool> moving(scene.nodes.size(), false);
    moving.back() = true;
    const auto last = uint32_t(scene.nodes.size() - 1);
    for (const Radiosity::Source& source : gathered(scene, {}, moving).sources)
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
    const Radiosity few = gathered(scene), many = gathered(scene, {.rays = 3200});
    const std::vector<vec3> light = few.solve({.reflections = 1}).other, wanted = many.solve({.reflections = 1}).other;
    std::vector<double> ratios;
    for (size_t i = 0; i < light.size(); ++i)
        if (const std::optional<uint32_t> other = many.find(few.numbers[i]);
            other && !few.grid.is_air(few.numbers[i]) && few.grid.side(few.numbers[i]) != 2 && wanted[*other].g > 0.01f)
            ratios.push_back(double(light[i].g) / double(wanted[*other].g));
    ASSERT_GT(ratios.size(), 300u);
    double mean = 0, variance = 0;
    for (const double ratio : ratios) mean += ratio / double(ratios.size());
    for (const double ratio : ratios) variance += (ratio - 1) * (ratio - 1) / double(ratios.size());
    EXPECT_NEAR(mean, 1, 0.03);
    EXPECT_LT(std::sqrt(variance), 0.13);
}

// In the open over a wide black floor: from above the whole sky, from below nothing, from the side half, and slopes
// something between.
TEST(GatherRadiosity, TheAirOverAFloorLightsWhatMovesThere) {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0), 200);  // beyond it are 0.5 % of a side's light
    const Radiosity radiosity = gathered(scene, {.cell_size = 5, .rays = 512});
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

// A carpet 4 cm over a floor, and a closed body through it: of the places in their cells those that nobody sees
// count for nothing.
TEST(GatherRadiosity, CoveredPlacesDoNotDarkenWhatIsSeen) {
    scene::Scene scene;
    add_floor(scene, add_material(scene, 0.5f), 8);
    add_box(scene, 0, {2.3f, 0.005f, 2.3f}, {-4, 0.045f, -4});  // 4 to 5 cm over the floor
    add_box(scene, 0, {1.7f, 0.2f, 1.7f}, {4, 0.15f, 4});       // some of it below
    const Radiosity radiosity = gathered(scene);
    const std::vector<vec3> light = radiosity.solve({.sky = dvec3(1 / kPi), .reflections = 0}).other;
    for (double x = -7.5; x < 8; x += 0.5)
        for (double z = -7.5; z < 8; z += 0.5) {
            const bool body = std::abs(x - 4) < 1.7 && std::abs(z - 4) < 1.7;
            const bool carpet = std::abs(x + 4) < 2.3 && std::abs(z + 4) < 2.3;
            const double height = body ? 0.35 : carpet ? 0.05 : 0;
            // Before the body's sides, 35 cm high, a place loses up to half of its sky; some are in cells of its top.
            const bool near = !body && std::abs(x - 4) < 4 && std::abs(z - 4) < 4;
            EXPECT_GE(radiosity.at(light, {x, height, z}, kUp).g, near ? 0.5 : body ? 0.8 : 0.93) << x << ", " << z;
        }
}

// Walls as modelling programs export them, closed and double-sided: the dark sides of their sheets count for nothing.
TEST(GatherRadiosity, WallsOfDoubleSidedSheetsAreAsBrightAsOthers) {
    const auto light_of = [](bool double_sided, dvec3 point, dvec3 normal) {
        scene::Scene scene;
        const uint32_t grey = add_material(scene, 0.5f);
        scene.materials[grey].double_sided = double_sided;
        add_floor(scene, grey, 8);
        add_box(scene, grey, {4, 1.5f, 0.1f}, {0, 1.5f, 0});      // 20 cm thick
        add_box(scene, grey, {0.3f, 1.5f, 3}, {-5.2f, 1.5f, 0});  // 60 cm
        add_box(scene, grey, {1.5f, 0.15f, 1.5f}, {4, 2, 4});     // a slab, 30 cm
        const Radiosity radiosity = gathered(scene);
        return radiosity.at(radiosity.solve({.sky = dvec3(1 / kPi)}).other, point, normal).g;
    };
    for (const auto& [point, normal] :
         {std::pair(dvec3(1, 1.6, 0.1), dvec3(0, 0, 1)), std::pair(dvec3(-1, 1.4, -0.1), dvec3(0, 0, -1)),
          std::pair(dvec3(-4.9, 1.5, 1.2), dvec3(1, 0, 0)), std::pair(dvec3(-5.5, 1.5, -1.2), dvec3(-1, 0, 0)),
          std::pair(dvec3(4, 2.15, 4), kUp), std::pair(dvec3(4, 1.85, 4), -kUp), std::pair(dvec3(3, 0, -5), kUp)}) {
        const double one = light_of(false, point, normal);
        EXPECT_NEAR(light_of(true, point, normal), one, 0.06 * one) << point.x << ", " << point.y << ", " << point.z;
    }
}

// A house of double-sided sheets with sills that go as far into it as they stand out: their hidden halves, which see
// the inside of the house, count for nothing; the same where its material may have holes, and has none.
TEST(GatherRadiosity, PartsThatReachIntoAHouseAreAsBrightAsThoseThatEndAtItsWall) {
    const auto light_below = [](float inside, scene::Material::Alpha alpha = scene::Material::Alpha::Opaque) {
        scene::Scene scene;
        const uint32_t grey = add_material(scene, 0.5f);
        scene.materials[grey].double_sided = true, scene.materials[grey].alpha = alpha;
        add_floor(scene, grey, 12);
        add_box(scene, grey, {3, 3, 4}, {-3, 3.1f, 0});  // its wall is at x = 0
        for (int i = -3; i <= 3; ++i)
            add_box(scene, grey, {0.5f * (0.3f + inside), 0.1f, 0.4f}, {0.5f * (0.3f - inside), 2.8f, float(i)});
        const Radiosity radiosity = gathered(scene);
        const std::vector<vec3> light = radiosity.solve({.sky = dvec3(1 / kPi)}).other;
        double sum = 0;
        for (int i = -3; i <= 3; ++i) sum += radiosity.at(light, {0.15, 2.7, double(i)}, -kUp).g / 7;
        return sum;
    };
    EXPECT_NEAR(light_below(0.3f), light_below(0), 0.1 * light_below(0));
    EXPECT_EQ(light_below(0.3f, scene::Material::Alpha::Mask), light_below(0.3f));
}

// A floor with crates under a roof of one double-sided sheet has the light and the area of one under a roof with two
// sides: it is no inside of a body.
TEST(GatherRadiosity, AFloorUnderASheetIsOutside) {
    const auto gathered_under = [](bool sheet) {
        scene::Scene scene;
        const uint32_t grey = add_material(scene, 0.5f);
        add_floor(scene, grey, 8);
        for (int i = -2; i <= 2; ++i) add_box(scene, grey, {0.3f, 0.3f, 0.3f}, {float(i), 0.31f, float(i)});
        const uint32_t roof = add_material(scene, 0.5f);
        scene.materials[roof].double_sided = sheet;
        add_rectangle(scene, roof, {-4, 3, 4}, {8, 0, 0}, {0, 0, -8});
        if (!sheet) add_rectangle(scene, roof, {-4, 3, -4}, {8, 0, 0}, {0, 0, 8});
        return gathered(scene);
    };
    const Radiosity sheet = gathered_under(true), roof = gathered_under(false);
    const auto of_sheet = lux(sheet.solve({.sky = dvec3(1 / kPi)}).other),
               of_roof = lux(roof.solve({.sky = dvec3(1 / kPi)}).other);
    const auto is_floor = [](const Radiosity& radiosity) {
        return [&](size_t i, dvec3 at) {
            return radiosity.grid.side(radiosity.numbers[i]) == 2 && std::abs(at.y) < 0.5 &&
                   std::max(std::abs(at.x), std::abs(at.z)) < 4;
        };
    };
    const double wanted = mean_over(roof, of_roof, is_floor(roof));
    EXPECT_NEAR(mean_over(sheet, of_sheet, is_floor(sheet)), wanted, 0.06 * wanted);
    const auto area = [&](const Radiosity& radiosity) {
        double sum = 0;
        for (size_t i = 0; i < radiosity.cells(); ++i)
            if (is_floor(radiosity)(i, radiosity.grid.middle(radiosity.numbers[i]))) sum += double(radiosity.areas[i]);
        return sum;
    };
    EXPECT_NEAR(area(sheet), area(roof), 0.05 * area(roof)) << "crates cut some";
}

// In coarse cells, whose numbers those of the air have, too.
TEST(GatherRadiosity, PlacesInTheAirReplaceNoneOfSurfaces) {
    using transport::Exposure;
    const transport::CellGrid grid{.size = 1, .count = {8, 8, 8}};
    const uint32_t number = grid.air_cell({0, 0, 0}, 2).value();
    const auto with = [&](std::initializer_list<Exposure> exposures) {
        transport::CellPlaces cell;
        for (const Exposure exposure : exposures) {
            const bool air = exposure == Exposure::Air;
            add_place(cell, grid, number,
                      {{1, 1, 1}, kUp, dvec3(air ? 0 : 0.5), air ? scene::kNone : 0, 1, air ? 0.0 : 1.0, exposure});
        }
        return cell;
    };
    for (const Exposure of_surface : {Exposure::Open, Exposure::Near, Exposure::Partly})
        for (const auto& cell : {with({of_surface, Exposure::Air}), with({Exposure::Air, of_surface})}) {
            EXPECT_EQ(cell.places[0].node, 0u);
            EXPECT_EQ(cell.reflectance.g / cell.weight, 0.5);
            EXPECT_EQ(cell.area, 1);
        }
    EXPECT_EQ(with({Exposure::Air, Exposure::Covered}).places[0].node, scene::kNone);
    EXPECT_EQ(with({Exposure::Covered, Exposure::Air}).places[0].node, scene::kNone);
}

// Two closed rooms side by side, a wall between, one of them lit. Rays find no way through. The cells of floor and
// ceiling that the wall crosses are cut there, but for some of which few places were found: of the light in the middle
// of the lit room 0.04 are found beside the wall, one room further 0.005.
TEST(GatherRadiosity, LightThroughAWallStaysNearIt) {
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
                EXPECT_LE(mean(3 + double(thick) + beyond), (beyond > 4 ? 0.006 : 0.05) * bright)
                    << beyond << " m beyond " << thick << " m at " << degrees;
        }
}

// A border of cubes lies in the wall: no light goes through it.
TEST(GatherRadiosity, AWallBetweenCubesPartsThem) {
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

// Beside an ordinary floor: triangles with corners that are no places change nothing, whichever corner it is.
// cos^1000 away from the axis: denormal numbers, of which no sum is even steps.
TEST(GatherRadiosity, ABeamThatGivesNextToNothingEnds) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0.5f), {-40, 0, 40}, {80, 0, 0}, {0, 0, -80});
    add_lamp(scene, 1000, {0, 4, 0});
    scene.lamps[0].kind = scene::Lamp::Kind::CosinePower, scene.lamps[0].exponent = 1000;
    const transport::Radiosity radiosity = gathered(scene, {.cell_size = 4});
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
        return radiosity.grid.side(radiosity.numbers[i]) == 2 && middle.y < -2;
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
    const Radiosity wide = gathered(scene, {.most_cells = 5'000});
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

// Small triangles with far more cells than their area says.
TEST(GatherRadiosity, TheNumberOfCellsOfScatteredTrianglesIsBounded) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0.5f), {0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0});
    scene::Primitive& p = scene.meshes[0].primitives[0];
    for (uint32_t i = 1; i < 300'000; ++i)
        for (const uint32_t corner : {0u, 1u, 2u}) {
            scene::Vertex vertex = p.vertices[corner];
            vertex.position += 200.0f * glm::fract(float(i) * glm::vec3(0.8191725f, 0.6710436f, 0.5497005f));
            p.bounds.add(vertex.position);
            p.indices.push_back(uint32_t(p.vertices.size())), p.vertices.push_back(vertex);
        }
    const transport::RadiositySettings settings{.rays = 4, .looks = 1, .most_cells = 2'000};
    const auto world = scene::world_transforms(scene, 0);
    const rays::RayCaster rays(scene, world);
    const transport::Surfaces surfaces(scene, world);
    const auto cells = transport::SurfaceCells::of(scene, world, transport::Emitters(scene, world, surfaces), settings);
    EXPECT_LT(find_places(scene, world, rays, surfaces, *cells, 2'000, {})->size(), 200'000u)
        << "no more are looked at";
    const Radiosity radiosity = gathered(scene, settings);
    EXPECT_LE(radiosity.cells(), 2 * 3'000u) << "and those of backs that rays find";
    EXPECT_GE(radiosity.cells(), 500u);
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
