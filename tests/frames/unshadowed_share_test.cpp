// Lamps that cast no shadow, as a setting. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "render/renderer.h"
#include "support/rooms.h"

namespace vesper::test {
namespace {

// A card that moves below two lamps that move, one of them faint; and a view from above, or aside.
struct Cards {
    scene::Scene scene;
    gpu_scene::SceneFrame moment;
    gpu_scene::View view = from(0);
    render::RenderSettings settings;
    uint32_t card = 0, bright = 0, faint = 0;

    Cards() {
        const uint32_t grey = add_material(scene, 0.5f);
        add_rectangle(scene, grey, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
        add_rectangle(scene, grey, {-1, 2, 1}, {2, 0, 0.3f}, {-0.3f, 0, -2});
        card = uint32_t(scene.nodes.size()) - 1;
        add_lamp(scene, 1000, {1, 4, 0});
        bright = uint32_t(scene.nodes.size()) - 1;
        add_lamp(scene, 20, {-1, 4, 0});
        faint = uint32_t(scene.nodes.size()) - 1;
        moment.world = scene::world_transforms(scene, 0);
        moment.dimming.assign(scene.nodes.size(), 1);
        moment.moving.assign(scene.nodes.size(), false);
        for (const uint32_t node : {card, bright, faint}) moment.moving[node] = true;
        settings.indirect = settings.anti_aliasing = false;
        settings.unshadowed_share = 0.1f;
    }
    static gpu_scene::View from(double x) {
        return gpu_scene::View::symmetric(
            {96, 96}, 0.9f, glm::dmat4(glm::lookAt(glm::dvec3(x, 12, 0), glm::dvec3(x, 0, 0), glm::dvec3(0, 0, -1))));
    }
    void move(double x) {
        for (const uint32_t node : {card, bright, faint}) moment.world[node][3].x += x;
    }
    render::Frame render(render::Renderer& renderer) const {
        return renderer.render(settings, view, moment, 0, {.display = false, .scene = true});
    }
};

TEST(UnshadowedShare, LeavesOutTheFaintest) {
    Cards cards;
    gpu::Device device({.select = ""});
    render::Renderer renderer(device, cards.scene);
    EXPECT_EQ(cards.render(renderer).visibility.unshadowed, 1u);
    cards.settings.unshadowed_share = 1;
    EXPECT_EQ(cards.render(renderer).visibility.unshadowed, 2u);
    EXPECT_NEAR(cards.render(renderer).visibility.unshadowed_light, 1e6, 10);
}

// A picture depends on its view and moment, whatever was rendered before.
TEST(UnshadowedShare, DependsOnNoOtherFrame) {
    Cards cards;
    gpu::Device device({.select = ""});
    render::Renderer renderer(device, cards.scene);
    const auto as_alone = [&](const char* what) {
        SCOPED_TRACE(what);
        render::Renderer anew(device, cards.scene);
        const render::Frame alone = cards.render(anew), among = cards.render(renderer);
        EXPECT_EQ(among.visibility.unshadowed, alone.visibility.unshadowed);
        EXPECT_EQ(among.scene, alone.scene);
    };
    as_alone("first");
    cards.move(0.3), as_alone("moved");
    cards.move(0.3), as_alone("moved again");
    cards.moment.dimming[cards.bright] = 1e-3f, as_alone("the other is faint");
    cards.moment.dimming[cards.bright] = 1, as_alone("and bright");
    cards.view = Cards::from(2), as_alone("another view");
    cards.view = Cards::from(0), as_alone("the first view");
    cards.settings.unshadowed_share = 0, as_alone("all cast shadows");
    cards.settings.unshadowed_share = 0.1f, as_alone("not all");
    cards.settings.samples = 4, as_alone("several points of a pixel");
    cards.settings.samples = 1, as_alone("one");
}

}  // namespace
}  // namespace vesper::test
