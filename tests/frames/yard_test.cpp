// The yard of data/photometry: a cut-off line on a wall, and the sheen of a wet road towards headlamps.
// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <filesystem>

#include <gtest/gtest.h>

#include "gpu_scene/cameras.h"
#include "places.h"
#include "render/renderer.h"
#include "scene/convert.h"
#include "scene/read_scene.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
constexpr VkExtent2D kYardExtent{320, 200};

/// Green luminance at a point of the world, cd/m^2.
double seen_at(const render::Frame& frame, const gpu_scene::View& view, glm::vec3 point) {
    const glm::vec4 eye = view.world_to_view * glm::vec4(point, 1);
    const glm::vec2 at = (glm::vec2(eye) / -eye.z - view.tangent_low) / (view.tangent_high - view.tangent_low);
    const auto x = size_t(at.x * float(kYardExtent.width)), y = size_t((1 - at.y) * float(kYardExtent.height));
    return double(frame.scene.at(4 * (y * kYardExtent.width + x) + 1));
}

TEST(Yard, ShowsTheCutOffAndTheSheen) {
    const fs::path folder = fs::temp_directory_path() / ("vesper-yard-" + std::to_string(getpid())),
                   data = fs::path(VESPER_SOURCE_DIR) / "data/photometry";
    fs::create_directories(folder);
    scene::convert(data / "yard.gltf", data / "yard.photometry.json", folder / "yard.gltf", {});
    const scene::Scene scene = scene::read_scene(folder / "yard.gltf").scene;
    fs::remove_all(folder);
    gpu::Device device({.select = ""});
    render::Renderer renderer(device, scene);
    const gpu_scene::SceneFrame moment{scene::world_transforms(scene, 0)};
    const auto look = [&](const char* camera) { return gpu_scene::camera_view(scene, moment, camera, kYardExtent); };

    // The line lies 1 % below the lamps on the left: at 0.53 m, 12 m away.
    const gpu_scene::View wall = look("wall");
    const render::Frame cut = renderer.render({}, wall, moment, 0, {.display = false, .scene = true});
    EXPECT_GT(seen_at(cut, wall, {27, 0.4, -12}), 8 * seen_at(cut, wall, {27, 0.65, -12}));
    EXPECT_GT(seen_at(cut, wall, {32.5, 0.65, -12}), 3 * seen_at(cut, wall, {27, 0.65, -12}))
        << "it rises to the right";
    EXPECT_GT(seen_at(cut, wall, {30.2, 0.45, -12}), 3 * seen_at(cut, wall, {27, 0.45, -12})) << "the hot spot";

    // Headlamps at -70 m, over the wet half: before them it shines, beside it and on the dry half it does not.
    const gpu_scene::View road = look("sheen");
    const render::Frame wet = renderer.render({}, road, moment, 0, {.display = false, .scene = true});
    const double sheen = seen_at(wet, road, {-1.4, 0, -50});
    EXPECT_GT(sheen, 3 * seen_at(wet, road, {-3.8, 0, -50}));
    EXPECT_GT(sheen, 3 * seen_at(wet, road, {1.4, 0, -50}));
}

}  // namespace
}  // namespace vesper::test
