// Emitting triangles and their parts. SPDX-License-Identifier: MIT
#include "transport/emitters.h"

#include <gtest/gtest.h>

#include "support/rooms.h"
#include "transport/sampling.h"

namespace vesper::test::emitters_test {
namespace {

using glm::dvec3, transport::Emitters;

/// A panel that emits, in the plane z = 0, with texture coordinates from 0 to 1.
scene::Scene panel(float width, float height, float luminance) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0, luminance), {0, 0, 0}, {width, 0, 0}, {0, height, 0});
    std::vector<scene::Vertex>& corners = scene.meshes[0].primitives[0].vertices;
    for (scene::Vertex& corner : corners) corner.uv = {corner.position.x / width, corner.position.y / height};
    return scene;
}

/// Black on the left, white on the right.
void add_picture(scene::Scene& scene) {
    scene.images.push_back({.name = "picture", .width = 2, .height = 1, .rgba = {0, 0, 0, 255, 255, 255, 255, 255}});
    scene.materials[0].emission_texture = {0, scene::Wrap::Clamp, scene::Wrap::Clamp, true};
}

Emitters emitters_of(const scene::Scene& scene) {
    const auto world = scene::world_transforms(scene, 0);
    return {scene, world, transport::Surfaces(scene, world)};
}

TEST(Emitters, PartsCoverTheirTriangles) {
    const Emitters emitters = emitters_of(panel(3, 2, 50));
    EXPECT_EQ(emitters.list().size(), 2u * 64) << "sides of 3.6 m, in parts of 0.45 m";
    double area = 0;
    dvec3 middle(0);
    for (const Emitters::Emitter& e : emitters.list()) {
        area += e.area, middle += e.area * (e.corners[0] + e.corners[1] + e.corners[2]) / 3.0;
        EXPECT_NEAR(glm::dot(glm::cross(e.corners[1] - e.corners[0], e.corners[2] - e.corners[0]), e.outwards),
                    2 * e.area, 1e-6)
            << "it turns as its triangle does";
        EXPECT_EQ(e.luminance, 50);
    }
    EXPECT_NEAR(area, 6, 1e-6);
    EXPECT_NEAR(glm::distance(middle / area, dvec3(1.5, 1, 0)), 0, 1e-6);
}

TEST(Emitters, SmallAndHugeTrianglesAreWhole) {
    EXPECT_EQ(emitters_of(panel(0.3f, 0.3f, 50)).list().size(), 2u);
    EXPECT_EQ(emitters_of(panel(0.5f, 0.5f, 50)).list().size(), 2u * 4);
    EXPECT_EQ(emitters_of(panel(80, 1, 50)).list().size(), 2u);
}

TEST(Emitters, PlacesAreFoundAgain) {
    const Emitters emitters = emitters_of(panel(3, 2, 50));
    transport::Random random(7);
    for (size_t i = 0; i < emitters.list().size(); ++i)
        for (int k = 0; k < 20; ++k) {
            const Emitters::Place place = emitters.place_on(i, {random.next(), random.next()});
            EXPECT_EQ(emitters.find(place.hit), i);
            const dvec3 w = place.hit.weights;
            EXPECT_NEAR(w.x + w.y + w.z, 1, 1e-12);
            // The triangles are (0, 1, 2) and (0, 2, 3) of the rectangle's corners.
            const dvec3 there =
                place.hit.triangle == 0 ? dvec3(3 * (w.y + w.z), 2 * w.z, 0) : dvec3(3 * w.y, 2 * (w.y + w.z), 0);
            EXPECT_NEAR(glm::distance(place.point, there), 0, 1e-6);
        }
    EXPECT_FALSE(emitters.find({.share = 1, .node = 0, .primitive = 0, .triangle = 2}));
    // At the corners, and a little beyond them, as rounding has it.
    for (const dvec3 weights : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1), dvec3(1 + 1e-9, -1e-9, 0)})
        EXPECT_LT(emitters.find({.share = 1, .node = 0, .primitive = 0, .triangle = 1, .weights = weights}).value(),
                  emitters.list().size());
}

TEST(Emitters, PartsHaveTheLightOfTheirPicture) {
    scene::Scene scene = panel(4, 2, 100);
    add_picture(scene);
    const Emitters emitters = emitters_of(scene);
    double power = 0;
    for (const Emitters::Emitter& e : emitters.list()) {
        const double left = std::min({e.corners[0].x, e.corners[1].x, e.corners[2].x}),
                     right = std::max({e.corners[0].x, e.corners[1].x, e.corners[2].x});
        if (left >= 2) {
            EXPECT_NEAR(e.luminance, 100, 1e-9);
        } else if (right <= 2) {
            EXPECT_NEAR(e.luminance, 5, 1e-9) << "so that what was not looked up is looked at";
        }
        power += e.luminance * e.area;
    }
    EXPECT_NEAR(power, 4 * 100 + 4 * 5, 20);
    // Chosen as often as they give.
    const transport::EmitterChoice choice(emitters);
    double all = 0, bright = 0;
    for (size_t i = 0; i < emitters.list().size(); ++i) {
        all += choice.probability(i);
        if (emitters.list()[i].luminance > 50) bright += choice.probability(i);
    }
    EXPECT_NEAR(all, 1, 1e-9);
    EXPECT_GT(bright, 0.9);
}

// Wherever a small bright spot of a picture lies, looks find it at least half as often as by areas.
TEST(Emitters, PartsHaveHalfOfThePictureAtLeast) {
    scene::Scene scene = panel(4, 4, 1);
    photometry::LuminancePicture picture;
    picture.width = picture.height = 256, picture.rgb.resize(size_t{256} * 256 * 3, 0.0f);
    for (const size_t channel : {0u, 1u, 2u}) picture.rgb[(256 * 100 + 77) * 3 + channel] = 65536;
    scene.luminance_pictures.push_back(picture);
    scene.materials[0].emission_picture = {0, scene::Wrap::Clamp, scene::Wrap::Clamp, true};
    const Emitters emitters = emitters_of(scene);
    for (const Emitters::Emitter& e : emitters.list()) EXPECT_GE(e.luminance, 0.5 * (1 - 1e-6));
}

}  // namespace
}  // namespace vesper::test::emitters_test
