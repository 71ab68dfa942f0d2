// Which cells surfaces have: small ones near light, where a scene is large. SPDX-License-Identifier: MIT
#include "transport/surface_cells.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/gathered.h"
#include "support/rooms.h"

namespace vesper::test::surface_cells_test {
namespace {

using glm::dvec3, transport::SurfaceCells;

/// Ground of 400 m x 400 m with a lamp over a wall of 4 m x 4 m, or an emitter instead.
scene::Scene terrain(bool emits = false) {
    scene::Scene scene;
    const uint32_t matt = add_material(scene, 0.25f);
    add_rectangle(scene, matt, {-200, 0, 200}, {400, 0, 0}, {0, 0, -400});
    if (emits) {
        add_rectangle(scene, add_material(scene, 0, 50), {150, 0, 150}, {1, 0, 0}, {0, 1, 0});
    } else {
        add_rectangle(scene, matt, {148, 0, 146}, {4, 0, 0}, {0, 4, 0});
        add_lamp(scene, 1000, {150, 5, 150});
    }
    scene.sky_luminance = 10, scene.sky_colour = glm::vec3(1);
    return scene;
}

std::optional<SurfaceCells> cells_of(const scene::Scene& scene, uint64_t most, uint64_t fine = 0) {
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const transport::Surfaces surfaces(scene, world);
    return SurfaceCells::of(scene, world, transport::Emitters(scene, world, surfaces),
                            {.fine_cells = fine, .most_cells = most});
}

TEST(SurfaceCells, AreAllSmallWhereThereIsRoom) {
    const auto cells = cells_of(terrain(), 200'000);
    EXPECT_EQ(cells->grid.size, 1);
    EXPECT_TRUE(cells->is_fine({-150, 0, -150}));
    EXPECT_FALSE(cells_of({}, 1000).has_value());
}

// 160,000 m^2: cells of a metre are the largest of small ones, and the smallest of others.
TEST(SurfaceCells, AreAsSmallAsTheirNumberAllows) {
    const auto size = [](uint64_t fine) { return cells_of(terrain(), 200'000, fine)->grid.size; };
    EXPECT_EQ(size(0), 1);
    EXPECT_EQ(size(200'000), 1) << "with the 16 m^2 of the wall; at 0.7 m there would be 320,000";
    EXPECT_NEAR(size(330'000), std::numbers::sqrt2 / 2, 1e-9);
    scene::Scene small;
    add_rectangle(small, add_material(small, 0.5f), {0, 0, 0}, {30, 0, 0}, {0, 0, 30});
    EXPECT_NEAR(cells_of(small, 600'000, 20'000'000)->grid.size, 0.125, 1e-9) << "none smaller than the settings say";
    EXPECT_EQ(cells_of(terrain(), 20'000, 1'000'000)->grid.size, 1) << "a large scene has none";
    // Little surface in much space: numbers of cubes of 0.7 m do not fit, those of 1 m do.
    scene::Scene wide;
    add_rectangle(wide, add_material(wide, 0.5f), {0, 0, 0}, {30, 0, 0}, {0, 0, 30});
    add_rectangle(wide, 0, {700, 300, 700}, {1, 0, 0}, {0, 0, 1});
    EXPECT_EQ(cells_of(wide, 600'000, 100'000)->grid.size, 1);
}

TEST(SurfaceCells, AreSmallNearLightOnly) {
    for (const bool emits : {false, true}) {
        const auto cells = cells_of(terrain(emits), 20'000);
        EXPECT_EQ(cells->grid.size, 1) << "96 x 96 m, and a 16th of the rest";
        for (const dvec3 off : {dvec3(0), dvec3(31, 0, 0), dvec3(0, 0, -31), dvec3(-31, 0, 31)}) {
            const dvec3 at = dvec3(150, 0, 150) + off;
            EXPECT_TRUE(cells->is_fine(at));
            EXPECT_EQ(cells->number(at, {0, 1, 0}), cells->grid.cell_at(at, {0, 1, 0}));
        }
        const dvec3 far(-100, 0, 20);
        EXPECT_FALSE(cells->is_fine(far));
        EXPECT_TRUE(cells->grid.is_air(cells->number(far, {0, 1, 0}).value()));
    }
    EXPECT_GT(cells_of(terrain(), 10'000)->grid.size, 1) << "too many yet";
    scene::Scene dark = terrain();
    dark.nodes.pop_back();
    EXPECT_GT(cells_of(dark, 20'000)->grid.size, 2) << "nothing is near light: as before";
}

// Both kinds of cells have the light of the open sky, and the wall gets that of the ground, which is lit by sky and
// lamp.
TEST(SurfaceCells, HaveTheLightOfAllKinds) {
    const scene::Scene scene = terrain();
    const transport::Radiosity large = gathered(scene, {.cell_size = 1, .fine_cells = 0, .most_cells = 20'000}),
                               whole = gathered(scene);
    EXPECT_LT(large.cells(), whole.cells() / 4);
    EXPECT_EQ(large.grid.size, 1);
    const transport::RadiosityLight light{.sky = dvec3(10)};
    const auto of_large = large.solve(light), of_whole = whole.solve(light);
    const double open = 10 * std::numbers::pi;
    for (const dvec3 at : {dvec3(-100, 0, 20), dvec3(0, 0, 0), dvec3(-190, 0, -190), dvec3(130, 0, 170)})
        EXPECT_NEAR(large.at(of_large.other, at, {0, 1, 0}).x, open, 0.03 * open) << at.x << ", " << at.z;
    const dvec3 wall(150, 1.5, 146);
    const double want = whole.at(of_whole.other, wall, {0, 0, 1}).x;
    EXPECT_NEAR(large.at(of_large.other, wall, {0, 0, 1}).x, want, 0.05 * want);
    double area = 0;
    for (const float of : large.areas) area += double(of);
    EXPECT_NEAR(area, 160'000, 0.02 * 160'000);
}

}  // namespace
}  // namespace vesper::test::surface_cells_test
