// A whole frame of a scene with a picture of the sky and a retroreflective sign. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "support/scene_geometry.h"

namespace vesper::test {
namespace {

// A white sign of class RA2 stands 100 m ahead under a uniform sky of 2 cd/m^2, lit by two lamps of 500 cd each, half a
// degree from the eye as the sign sees them: 12.5 cd/m^2 would come back of white. Its base colour is 0.5: half of
// that, and 1 cd/m^2 of the sky.
TEST(RendererSky, ASignUnderThePictureOfASky) {
    std::string complaints;
    gpu::Device device(
        {.select = "", .validation = true, .on_message = [&](const std::string& m) { complaints += m + "\n"; }});
    scene::Scene scene;
    scene.environment = photometry::Environment{64, 32, std::vector<float>(64 * 32 * 3, 2)};
    scene.retroreflectors = {photometry::retroreflective_class("RA1"), photometry::retroreflective_class("RA2")};
    scene::Material sign;
    sign.base_colour = {0.5f, 0.5f, 0.5f, 1};
    sign.metallic = 1;  // a sheet is no metal, whatever its material says
    sign.retroreflector = 1;
    scene.materials = {sign};
    add_mesh(scene, rectangle({-10, -10, -100}, {20, 0, 0}, {0, 20, 0}), kRectangle, 0);
    const float off = 100 * std::tan(glm::radians(0.5f));
    scene.lamps = {scene::Lamp{.name = "lamp", .kind = scene::Lamp::Kind::Point, .intensity = 500}};
    for (float side : {-off, off}) {
        scene::Node node;
        node.translation = {side, 0, 0}, node.lamp = 0;
        scene.nodes.push_back(node);
    }
    render::Renderer renderer(device, scene);
    const gpu_scene::View view = gpu_scene::View::symmetric({33, 33}, 0.4f, glm::mat4(1));
    const auto at = [&](const render::RenderSettings& settings, int x, int y) {
        const render::Frame frame =
            renderer.render(settings, view, {scene::world_transforms(scene, 0)}, 0, {.display = false, .scene = true});
        return frame.scene[size_t(y * 33 + x) * 4 + 1];
    };
    // 0.016: what 0.1 lx gives a matt surface of 0.5.
    EXPECT_NEAR(at({}, 16, 16), 12.5 / 2 + 1 + 0.016, 0.1);
    EXPECT_NEAR(at({}, 1, 1), 2, 1e-3) << "beside the sign";
    // The baseline knows neither.
    render::RenderSettings ldr;
    ldr.tone_operator = render::Operator::Ldr;
    EXPECT_EQ(at(ldr, 1, 1), 0);
    EXPECT_LE(at(ldr, 16, 16), 1);
    EXPECT_EQ(complaints, "");
}

}  // namespace
}  // namespace vesper::test
