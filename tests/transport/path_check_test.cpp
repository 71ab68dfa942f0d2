// Light of cells against that of paths: right where cells are right, and it shows what they lose.
// SPDX-License-Identifier: MIT
#include "transport/path_check.h"

#include <gtest/gtest.h>

#include "support/gathered.h"
#include "support/rooms.h"

namespace vesper::test::path_check_test {
namespace {

using transport::PathCheck, transport::Radiosity;

constexpr uint32_t kReflections = 32;

PathCheck check_of(const scene::Scene& scene, const Radiosity& radiosity) {
    return transport::check_by_paths(scene, scene::world_transforms(scene, 0), {}, radiosity, kReflections);
}

// In a cube of reflectance 0.5 as much light is reflected as comes from the lamp: 4 pi 100 lm on 6 * 25 m^2.
TEST(PathCheck, ARoomHasTheLightOfPaths) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), glm::vec3(2.5f));
    add_lamp(scene, 100, {0.3, 0.2, -0.4});
    const Radiosity radiosity = gathered(scene);
    const PathCheck check = check_of(scene, radiosity);
    EXPECT_GT(check.places, 400u);
    EXPECT_NEAR(check.paths, 8.38, 0.03 * 8.38);
    EXPECT_LT(check.error, 0.01);
    // The parts of corners that are near other walls do not count for their cells: 2 % are lost, give or take 1 %.
    EXPECT_NEAR(check.ratio(), 1, 0.05);
    EXPECT_EQ(check.cells, check_of(scene, radiosity).cells) << "the same each time";
    EXPECT_EQ(check.paths, check_of(scene, radiosity).paths) << "the same each time";
}

TEST(PathCheck, ShowsWhatCellsLose) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), glm::vec3(2.5f));
    add_lamp(scene, 100, {0.3, 0.2, -0.4});
    Radiosity radiosity = gathered(scene);
    for (glm::vec3& reflectance : radiosity.reflectances) reflectance = glm::vec3(0.4f);
    EXPECT_NEAR(check_of(scene, radiosity).ratio(), 0.4 / 0.6, 0.06) << "corners of a metre's cells lose some, too";
}

// The sky over a floor with a wall on it, and a house of sheets.
TEST(PathCheck, CountsTheSkyAndLeavesOutWhatIsCovered) {
    scene::Scene scene;
    const uint32_t grey = add_material(scene, 0.5f);
    scene.materials[grey].double_sided = true;
    scene.sky_luminance = 10;
    add_rectangle(scene, grey, {-6, 0, -6}, {0, 0, 12}, {12, 0, 0});
    add_box(scene, grey, {2, 2, 2}, {0, 2.1f, 0});
    const PathCheck check = check_of(scene, gathered(scene));
    EXPECT_GT(check.paths, 15);  // 10 pi lx in the open
    EXPECT_LT(check.paths, 31.5);
    EXPECT_NEAR(check.ratio(), 1, 0.1) << "too bright in the gap below the house";
}

TEST(PathCheck, WithoutLightThereIsNothingToCompare) {
    scene::Scene scene;
    EXPECT_EQ(check_of(scene, gathered(scene)).places, 0u);
    add_room(scene, add_material(scene, 0.5f), glm::vec3(2.5f));
    const PathCheck dark = check_of(scene, gathered(scene));
    EXPECT_EQ(dark.ratio(), 0);
    EXPECT_EQ(dark.error, 0);
}

}  // namespace
}  // namespace vesper::test::path_check_test
