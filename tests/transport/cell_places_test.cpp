// Which places of surfaces count for their cells. SPDX-License-Identifier: MIT
#include "transport/cell_places.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include <gtest/gtest.h>

#include "support/gathered.h"
#include "support/rooms.h"

namespace vesper::test::cell_places_test {
namespace {

using glm::dvec3, glm::vec3, transport::Radiosity;

constexpr double kPi = std::numbers::pi;
const dvec3 kUp(0, 1, 0);

// A carpet 4 cm over a floor, and a closed body through it: of the places in their cells those that nobody sees
// count for nothing.
TEST(CellPlaces, CoveredPlacesDoNotDarkenWhatIsSeen) {
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
TEST(CellPlaces, WallsOfDoubleSidedSheetsAreAsBrightAsOthers) {
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
TEST(CellPlaces, PartsThatReachIntoAHouseAreAsBrightAsThoseThatEndAtItsWall) {
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
TEST(CellPlaces, AFloorUnderASheetIsOutside) {
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
            return radiosity.grid.facing(radiosity.numbers[i]) == 2 && std::abs(at.y) < 0.5 &&
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
TEST(CellPlaces, PlacesInTheAirReplaceNoneOfSurfaces) {
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

// Small triangles with far more cells than their area says.
TEST(CellPlaces, TheNumberOfCellsOfScatteredTrianglesIsBounded) {
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
    const transport::RadiositySettings settings{
        .cell_size = 1, .rays = 4, .looks = 1, .fine_cells = 0, .most_cells = 2'000};
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

}  // namespace
}  // namespace vesper::test::cell_places_test
