// The resolution of shadow maps as a setting. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "render/renderer.h"
#include "support/rooms.h"

namespace vesper::test {
namespace {

// A card hides a lamp from a floor: other texels see another edge, and the same ones the same.
TEST(ShadowResolution, ChangesFromFrameToFrame) {
    scene::Scene scene;
    const uint32_t grey = add_material(scene, 0.5f);
    add_rectangle(scene, grey, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
    add_rectangle(scene, grey, {-1.03f, 2, 1.07f}, {2, 0, 0.3f}, {-0.3f, 0, -2});
    add_lamp(scene, 1000, {0, 4, 0});
    gpu::Device device({.select = ""});
    render::Renderer renderer(device, scene);
    const gpu_scene::SceneFrame moment{scene::world_transforms(scene, 0)};
    const gpu_scene::View above = gpu_scene::View::symmetric(
        {96, 96}, 0.9f, glm::dmat4(glm::lookAt(glm::dvec3(0, 12, 0), glm::dvec3(0), glm::dvec3(0, 0, -1))));
    render::RenderSettings settings;
    settings.indirect = settings.anti_aliasing = false;
    const auto seen = [&](double resolution) {
        settings.shadow_resolution = resolution;
        return renderer.render(settings, above, moment, 0, {.display = false, .scene = true});
    };
    const render::Frame usual = seen(1), coarse = seen(0.25), again = seen(1);
    EXPECT_EQ(again.scene, usual.scene);
    size_t other = 0;
    for (size_t i = 0; i < usual.scene.size(); i += 4) other += coarse.scene[i] != usual.scene[i];
    EXPECT_GT(other, 0u) << "no edge has moved";
    EXPECT_LT(other, usual.scene.size() / 4 / 20) << "more than edges has changed";
}

}  // namespace
}  // namespace vesper::test
