// Masked and clear materials: where rays pass. SPDX-License-Identifier: MIT
#include "rays/opacity.h"

#include <gtest/gtest.h>

#include "rays/ray_caster.h"
#include "support/occluders.h"

namespace vesper::test::opacity_test {
namespace {

using scene::Wrap;

/// A plate of 2 m x 2 m at z = 0 with uv from 0 to 1, masked at one half by a row of alpha codes.
scene::Scene masked_plate(const std::vector<uint8_t>& alpha, bool nearest, Wrap wrap = Wrap::Repeat) {
    OccluderScene made;
    made.plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    scene::Scene scene = made.scene();
    Image image{.name = "alpha", .width = uint32_t(alpha.size()), .height = 1, .rgba = {}};
    for (const uint8_t a : alpha)
        for (const uint8_t code : {uint8_t(255), uint8_t(255), uint8_t(255), a}) image.rgba.push_back(code);
    scene.images.push_back(image);
    scene.materials[0].alpha = scene::Material::Alpha::Mask;
    scene.materials[0].base_colour_texture = {0, wrap, wrap, nearest};
    return scene;
}

/// Whether the plate stops a ray at a share of its width.
bool stops(const scene::Scene& scene, double u) {
    const auto world = scene::world_transforms(scene, 0);
    const rays::RayCaster caster(scene, world);
    return caster.blocked({2 * u - 1, 0.3, 1}, {2 * u - 1, 0.3, -1});
}

TEST(Opacity, FollowsTheTexels) {
    const scene::Scene scene = masked_plate({255, 0, 0, 255}, true);
    for (const double u : {0.01, 0.24, 0.76, 0.99}) EXPECT_TRUE(stops(scene, u)) << u;
    for (const double u : {0.26, 0.5, 0.74}) EXPECT_FALSE(stops(scene, u)) << u;
}

// Between the middles of texels opacity is linear, round the edge, too: 255 falls to a half at the edge of a texel.
TEST(Opacity, IsLinearBetweenTexels) {
    const scene::Scene scene = masked_plate({255, 0, 64, 128}, false);
    EXPECT_TRUE(stops(scene, 0.245));
    EXPECT_FALSE(stops(scene, 0.255));
    EXPECT_FALSE(stops(scene, 0.87)) << "just short of the middle of the last texel";
    EXPECT_TRUE(stops(scene, 0.88));
    EXPECT_TRUE(stops(scene, 0.999)) << "the first texel follows the last";
    const scene::Scene clamped = masked_plate({0, 0, 0, 128}, false, Wrap::Clamp);
    EXPECT_TRUE(stops(clamped, 0.999));
    EXPECT_FALSE(stops(masked_plate({0, 0, 0, 128}, false), 0.999));
}

TEST(Opacity, WrapsAsGltfSays) {
    const auto at = [](Wrap wrap, float u) {
        scene::Scene scene = masked_plate({0, 255}, true, wrap);
        scene::Primitive& p = scene.meshes[0].primitives[0];
        for (scene::Vertex& vertex : p.vertices) vertex.uv = {u, 0};
        return rays::stops_light(scene, p, 0, {0.2, 0.3, 0.5});
    };
    const struct {
        float u;
        bool repeat, mirror, clamp;
    } cases[] = {{0.2f, false, false, false}, {0.7f, true, true, true},    {1.2f, false, true, true},
                 {1.7f, true, false, true},   {-0.2f, true, false, false}, {-0.7f, false, true, false},
                 {2.7f, true, true, true},    {1e30f, false, false, true}};
    for (const auto& c : cases) {
        EXPECT_EQ(at(Wrap::Repeat, c.u), c.repeat) << c.u;
        EXPECT_EQ(at(Wrap::Mirror, c.u), c.mirror) << c.u;
        EXPECT_EQ(at(Wrap::Clamp, c.u), c.clamp) << c.u;
    }
    EXPECT_TRUE(at(Wrap::Repeat, std::numeric_limits<float>::quiet_NaN()));
}

TEST(Opacity, MaterialAndCornersCount) {
    scene::Scene scene = masked_plate({255}, true);
    scene::Primitive& p = scene.meshes[0].primitives[0];
    scene.materials[0].base_colour.a = 0.8f;
    for (scene::Vertex& vertex : p.vertices) vertex.colour[3] = 0;
    p.vertices[0].colour[3] = 65535;
    EXPECT_NEAR(rays::opacity_at(scene, p, 0, {0.7, 0.2, 0.1}), 0.56, 1e-7);
    EXPECT_TRUE(rays::stops_light(scene, p, 0, {0.63, 0.2, 0.17}));
    EXPECT_FALSE(rays::stops_light(scene, p, 0, {0.62, 0.2, 0.18}));
    scene.materials[0].base_colour_texture = {};
    EXPECT_NEAR(rays::opacity_at(scene, p, 0, {0.7, 0.2, 0.1}), 0.56, 1e-7);
    // Wholly opaque is opaque at a cutoff of 1, however it is rounded.
    scene.materials[0].alpha_cutoff = 1, scene.materials[0].base_colour.a = 1;
    for (scene::Vertex& vertex : p.vertices) vertex.colour[3] = 65535;
    EXPECT_TRUE(rays::stops_light(scene, p, 0, {0.1, 0.2, 0.7}));
}

TEST(Opacity, SaysWhichMaterialsHaveHoles) {
    const auto has_holes = [](const scene::Scene& scene) -> bool { return rays::have_holes(scene).at(0); };
    EXPECT_FALSE(has_holes(masked_plate({255, 128}, true)));
    EXPECT_TRUE(has_holes(masked_plate({255, 127}, true)));
    scene::Scene scene = masked_plate({255, 128}, true);
    scene.meshes[0].primitives[0].vertices[1].colour[3] = 65000;
    EXPECT_TRUE(has_holes(scene)) << "corners count";
    scene.materials[0].base_colour_texture = {};
    EXPECT_FALSE(has_holes(scene)) << "opaque, though it is masked";
    scene.materials[0].base_colour.a = 0.5f;
    EXPECT_TRUE(has_holes(scene));
    scene.materials[0].alpha = scene::Material::Alpha::Opaque;
    EXPECT_FALSE(has_holes(scene));
    scene.meshes.clear(), scene.materials[0].alpha = scene::Material::Alpha::Mask;
    EXPECT_FALSE(has_holes(scene)) << "nothing has it";
}

TEST(Opacity, ClearMaterialsStopNothing) {
    scene::Scene scene = masked_plate({255}, true);
    EXPECT_TRUE(stops(scene, 0.5));
    scene.materials[0].clear = true;
    EXPECT_FALSE(stops(scene, 0.5));
    scene.materials[0].alpha = scene::Material::Alpha::Opaque;
    EXPECT_FALSE(stops(scene, 0.5));
    scene.materials[0].clear = false;
    scene.materials[0].base_colour.a = 0;
    EXPECT_TRUE(stops(scene, 0.5)) << "opacity has no meaning for opaque materials";
}

}  // namespace
}  // namespace vesper::test::opacity_test
