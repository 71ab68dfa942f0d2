// Lamps seen directly, on the device. SPDX-License-Identifier: MIT
#include "passes/luminaires_reference.h"

#include <random>

#include "render/passes/luminaires.h"
#include "support/compare.h"
#include "support/sources.h"
#include "support/texels.h"

namespace vesper::test::luminaires_test {
namespace {

using glm::dvec2, glm::dvec3;
using gpu_scene::View;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Pixels as large as those of 1050 rows over 0.6 rad.
View view_of(VkExtent2D extent, float pixel = 0.6f / 1050) {
    return View::symmetric(extent, 2 * std::atan(pixel * float(extent.height) / 2), glm::mat4(1));
}

struct Inputs {
    View view;
    gpu_scene::LuminaireList list;
    std::vector<float> depth;      ///< m, per pixel; 0: nothing
    std::vector<glm::vec4> scene;  ///< what was there before
};

Inputs on_black(const View& view, gpu_scene::LuminaireList list, float depth = 0) {
    const size_t pixels = size_t(view.extent.width) * view.extent.height;
    return {view, std::move(list), std::vector<float>(pixels, depth), std::vector<glm::vec4>(pixels, {0, 0, 0, 1})};
}

std::vector<glm::vec4> draw(PassRig& rig, const Inputs& in) {
    graph::FrameGraph graph;
    std::vector<glm::vec4> surfaces;
    for (const float depth : in.depth) surfaces.emplace_back(0, 0, depth, 1);
    const graph::Resource surface = rig.image(graph, "surface", render::kSurfaceFormat, in.view.extent, surfaces);
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, in.view.extent, in.scene);
    const graph::Resource kept =
        keep<glm::vec4>(graph, render::add_luminaires(rig.frame(graph, in.view), scene, surface, in.list));
    rig.run(graph);
    return rig.got<glm::vec4>(kept);
}

/// Lamps of every size, kind and direction, near and far, many of them beside the image.
Lamps many_lamps(uint32_t count, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::normal_distribution<float> normal;
    Lamps lamps;
    for (uint32_t i = 0; i < count; ++i) {
        const float depth = 2 * std::pow(300.0f, unit(random));
        scene::Lamp lamp =
            lamp_with_opening(1000 * unit(random), 0.05 + 0.3 * unit(random), 0.05 + 0.3 * unit(random), i % 2 == 0,
                              i % 3 == 0 ? scene::Lamp::Kind::Point : scene::Lamp::Kind::CosinePower);
        lamp.colour = glm::vec3(0.5f + unit(random), 0.5f + unit(random), 0.5f + unit(random));
        const glm::vec3 position(depth * 0.03f * normal(random), depth * 0.03f * normal(random), -depth);
        lamps.add(lamp, aimed(position, {normal(random), normal(random), 0.2f + std::abs(normal(random))}));
    }
    return lamps;
}

Inputs noisy(VkExtent2D extent, uint32_t lamps, uint32_t seed) {
    const View view = view_of(extent, 0.08f / float(std::max(extent.width, extent.height)));
    Inputs in = on_black(view, many_lamps(lamps, seed).seen(view));
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    for (size_t i = 0; i < in.depth.size(); ++i) {
        in.depth[i] = i % 5 == 0 ? 0 : 2 * std::pow(300.0f, unit(random));
        in.scene[i] = {unit(random), 100 * unit(random), 1e-3f * unit(random), 1};
        if (i % 11 == 3) in.scene[i].r = kNan;
        if (i % 13 == 5) in.scene[i].g = kInf;
    }
    return in;
}

TEST(Luminaires, MatchTheReferenceAtEverySize) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {64, 64}, {131, 37}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        const Inputs in = noisy(extent, 60, extent.width);
        ASSERT_FALSE(in.list.tiles.empty());
        const auto got = draw(rig, in);
        Picture have(extent.width, extent.height, 3), want = have, rounding = have;
        for (uint32_t y = 0, i = 0; y < extent.height; ++y)
            for (uint32_t x = 0; x < extent.width; ++x, ++i) {
                const reference::Added added = reference::added(in.list, x, y, in.depth[i]);
                for (int c = 0; c < 3; ++c) {
                    have.at(x, y, uint32_t(c)) = got[i][c];
                    want.at(x, y, uint32_t(c)) = double(in.scene[i][c]) + added.luminance[c];
                    rounding.at(x, y, uint32_t(c)) = added.rounding[c];
                }
                EXPECT_EQ(got[i].a, 1);
            }
        EXPECT_TRUE(same_light("sources", have, want, {3e-6, 1e-6}, rounding));
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Times the luminance of a headlamp, rounding of a coverage would be seen.
TEST(Luminaires, AddNothingBesideASilhouette) {
    PassRig rig;
    const View view = view_of({64, 64});
    const float pixel = view.ray_scale().x;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int k = 0; k < 20; ++k) {
        Lamps lamps;  // a disc about 10 px wide
        const float depth = 20, across = 10 * pixel * depth;
        lamps.add(lamp_with_opening(1e6, across, across, true, scene::Lamp::Kind::Point),
                  aimed({across * unit(random), across * unit(random), -depth}, {unit(random), 0, 1}));
        const Inputs in = on_black(view, lamps.seen(view));
        const auto got = draw(rig, in);
        glm::vec2 low(1e30f), high(-1e30f);
        for (const glm::vec2 corner : in.list.silhouettes)
            low = glm::min(low, corner + in.list.luminaires[0].origin),
            high = glm::max(high, corner + in.list.luminaires[0].origin);
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 64; ++x) {
                const bool beside =
                    float(x) >= high.x || float(x + 1) <= low.x || float(y) >= high.y || float(y + 1) <= low.y;
                ASSERT_TRUE(!beside || got[64 * y + x] == glm::vec4(0, 0, 0, 1)) << k << ": " << x << ", " << y;
            }
    }
}

// A headlamp that comes nearer from 2 km to 20 m, moved by tenths of a pixel.
TEST(Luminaires, AHeadlampKeepsItsLightAtAnyDistanceAndPosition) {
    PassRig rig;
    const View view = view_of({24, 20});
    const double pixel = view.ray_scale().x;
    double worst = 0, worst_step = 0, worst_shift = 0;
    for (const bool round : {false, true})
        for (const double distance : {20.0, 50.0, 150.0, 500.0, 2000.0}) {
            std::vector<glm::vec4> last;
            for (int step = 0; step <= 20; ++step) {
                SCOPED_TRACE(std::to_string(distance) + " m, step " + std::to_string(step));
                const dvec2 centre(11.3 + 0.1 * step, 9.6 + 0.03 * step);
                const dvec3 position = distance * dvec3((centre - dvec2(12, 10)) * dvec2(pixel, -pixel), -1);
                Lamps lamps;
                lamps.add(lamp_with_opening(9000, 0.18, 0.12, round), aimed(glm::vec3(position), {0.2f, 0, 1}));
                const auto pixels = draw(rig, on_black(view, lamps.seen(view)));

                const dvec3 axis = glm::normalize(dvec3(glm::vec3(0.2f, 0, 1)));
                const double d2 = glm::dot(position, position), cosine = glm::dot(axis, -position) / std::sqrt(d2);
                const double wanted = 9000 * cosine / d2, got = reference::illuminance(view, pixels);
                worst = std::max(worst, std::abs(got / wanted - 1));
                EXPECT_NEAR(got / wanted, 1, 1e-3);

                // Its light lies where the lamp is, and goes a tenth of a pixel further, not a pixel every tenth time.
                dvec2 middle(0);
                double sum = 0, change = 0;
                for (uint32_t i = 0; i < pixels.size(); ++i) {
                    middle += double(pixels[i].g) * (dvec2(i % 24, i / 24) + 0.5), sum += pixels[i].g;
                    if (!last.empty()) change += std::abs(double(pixels[i].g) - last[i].g);
                }
                worst_shift = std::max(worst_shift, glm::length(middle / sum - centre));
                if (!last.empty()) worst_step = std::max(worst_step, change / sum);
                last = pixels;
            }
        }
    EXPECT_LT(worst, 1e-3);
    EXPECT_LT(worst_shift, 0.1) << "px";
    // A lamp of a pixel's width loses at most a tenth of its light on one side, and wins it on the other.
    EXPECT_LT(worst_step, 0.32);
    RecordProperty("worst_illuminance", std::to_string(worst));
    RecordProperty("worst_step", std::to_string(worst_step));
    RecordProperty("worst_shift_px", std::to_string(worst_shift));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Luminaires, SurfacesHideLamps) {
    PassRig rig;
    const View view = view_of({32, 24});
    Lamps lamps;
    lamps.add(lamp_with_opening(9000, 0.2, 0.12), aimed({0, 0, -40}, {0, 0, 1}));
    const gpu_scene::LuminaireList list = lamps.seen(view);
    const double open = reference::illuminance(view, draw(rig, on_black(view, list)));
    EXPECT_NEAR(open, 9000.0 / (40 * 40), 1e-2);
    const auto behind = [&](auto depth) {
        Inputs in = on_black(view, list);
        for (uint32_t i = 0; i < in.depth.size(); ++i) in.depth[i] = depth(i % 32, i / 32);
        return reference::illuminance(view, draw(rig, in));
    };
    EXPECT_EQ(behind([](uint32_t, uint32_t) { return 39.0f; }), 0) << "a metre before the lamp";
    EXPECT_NEAR(behind([](uint32_t, uint32_t) { return 39.8f; }), open, 1e-4) << "its own glass";
    EXPECT_NEAR(behind([](uint32_t, uint32_t) { return 80.0f; }), open, 1e-4) << "a wall behind it";
    EXPECT_NEAR(behind([](uint32_t x, uint32_t) { return x < 16 ? 10.0f : 0.0f; }), open / 2, 1e-3 * open)
        << "half a car";
    EXPECT_EQ(rig.complaints(), "");
}

// A lamp sinks behind a roof: its light goes without a jump.
TEST(Luminaires, ALampDisappearsSmoothly) {
    PassRig rig;
    const View view = view_of({16, 16});
    double last = 0;
    for (int step = 0; step <= 40; ++step) {
        Lamps lamps;
        const float height = (2 - 0.1f * float(step)) * view.ray_scale().x * 800;
        lamps.add(lamp_with_opening(9000, 0.2, 0.2, true), aimed({0, height, -800}, {0, 0, 1}));
        Inputs in = on_black(view, lamps.seen(view));
        for (uint32_t i = 0; i < in.depth.size(); ++i) in.depth[i] = i / 16 < 8 ? 0.0f : 100.0f;
        const double now = reference::illuminance(view, draw(rig, in)) * 800 * 800 / 9000;
        if (step > 0) {
            EXPECT_LE(now, last + 1e-4);
            EXPECT_LT(last - now, 0.14) << "step " << step;
        } else {
            EXPECT_NEAR(now, 1, 1e-3);
        }
        last = now;
    }
    EXPECT_EQ(last, 0);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Luminaires, ALampNearTheEyeFillsTheImage) {
    PassRig rig;
    const View view = View::symmetric({45, 33}, 0.5f, glm::mat4(1));
    Lamps lamps;
    lamps.add(lamp_with_opening(500, 0.6, 0.5), aimed({0, 0, -0.3f}, {0, 0, 1}));
    for (const glm::vec4& pixel : draw(rig, on_black(view, lamps.seen(view)))) EXPECT_NEAR(pixel.g, 500 / 0.3, 2e-3);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Luminaires, EveryRunGivesTheSameBits) {
    PassRig rig;
    const Inputs in = noisy({200, 120}, 800, 5);
    const auto first = draw(rig, in), second = draw(rig, in);
    EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(glm::vec4)), 0);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Luminaires, WithoutLampsThereIsNoPass) {
    PassRig rig;
    const View view = view_of({8, 8});
    graph::FrameGraph graph;
    const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, view.extent));
    const graph::Resource surface = graph.transient("surface", graph::image_shape(render::kSurfaceFormat, view.extent));
    EXPECT_EQ(render::add_luminaires(rig.frame(graph, view), scene, surface, Lamps{}.seen(view)), scene);
    EXPECT_TRUE(graph.passes().empty());
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::luminaires_test
