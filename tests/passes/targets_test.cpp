// Targets on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/targets_reference.h"

#include "render/passes/targets.h"
#include "support/compare.h"
#include "support/noise.h"
#include "support/texels.h"

namespace vesper::test::targets_test {
namespace {

using glm::dvec2, glm::dvec3;

/// Noise: patches of instances, which belong to three targets and to none, and luminances over decades up to `most`
/// cd/m^2.
struct Case {
    VkExtent2D extent{};
    std::vector<glm::uvec2> triangles;
    std::vector<glm::vec4> scene, retina;
    std::vector<uint32_t> of_instances{0, 1, 2, 1, 0, 3};

    Case(VkExtent2D size, uint32_t seed, float most = 20) : extent(size) {
        Noise random(seed);
        for (uint32_t y = 0; y < size.height; ++y)
            for (uint32_t x = 0; x < size.width; ++x) {
                const uint32_t patch = (x / 5 + 3 * (y / 7) + seed) % 7;  // 6: nothing is drawn
                triangles.emplace_back(patch == 6 ? 0 : patch + 1, 12345);
                // Some about as bright as a glare source.
                const float light = (x + 3 * y) % 11 == 4 ? 60 + most * (1 + 22 * random.unit())
                                                          : most * std::pow(10.0f, -3 * random.unit());
                scene.emplace_back(light, light * random.unit(), light * random.unit(), 1);
                retina.push_back(scene.back() + 0.3f);
            }
    }
    dvec3 rgb(const std::vector<glm::vec4>& image, size_t i) const { return dvec3(glm::vec3(image[i])); }
    reference::TargetPicture picture(const gpu_scene::View& view) const {
        reference::TargetPicture p{
            int(extent.width), int(extent.height), dvec2(view.ray_scale()), dvec2(view.ray_offset()), {}, {}, {}};
        for (size_t i = 0; i < triangles.size(); ++i) {
            p.target.push_back(triangles[i].x == 0 ? 0 : of_instances[triangles[i].x - 1]);
            p.scene.push_back(rgb(scene, i)), p.retina.push_back(rgb(retina, i));
        }
        p.brightest = reference::brightest_surroundings(p.retina);
        return p;
    }
    /// The last level of a pyramid of the retina.
    glm::vec4 whole() const {
        std::vector<dvec3> pixels;
        for (size_t i = 0; i < retina.size(); ++i) pixels.push_back(rgb(retina, i));
        double sum = 0, logarithms = 0, n = 0;
        for (const dvec3& c : pixels) {
            const double l = 0.212639 * c.r + 0.715169 * c.g + 0.072192 * c.b;
            if (std::isfinite(l)) sum += l, logarithms += std::log(std::max(l, 1e-4)), ++n;
        }
        return {sum / std::max(n, 1.0), n, logarithms / std::max(n, 1.0), 0};
    }
};

std::vector<shared::TargetSums> measure(PassRig& rig, const Case& c, const gpu_scene::View& view,
                                        const std::vector<shared::TargetRect>& rects) {
    graph::FrameGraph graph;
    const render::TargetImages images{rig.image(graph, "triangle", render::kTriangleFormat, c.extent, c.triangles),
                                      rig.image(graph, "scene", render::kSceneFormat, c.extent, c.scene),
                                      rig.image(graph, "retina", render::kSceneFormat, c.extent, c.retina),
                                      rig.image(graph, "whole", render::kSceneFormat, {1, 1}, std::vector{c.whole()})};
    const graph::Resource kept =
        keep<shared::TargetSums>(graph, render::add_targets(rig.frame(graph, view), images, {c.of_instances, rects}));
    rig.run(graph);
    return rig.got<shared::TargetSums>(kept);
}

void expect_measured(const Case& c, const gpu_scene::View& view, const std::vector<shared::TargetRect>& rects,
                     const std::vector<shared::TargetSums>& got) {
    ASSERT_EQ(got.size(), rects.size());
    const reference::TargetPicture picture = c.picture(view);
    for (uint32_t t = 0; t < rects.size(); ++t) {
        SCOPED_TRACE(testing::Message() << c.extent.width << " x " << c.extent.height << ", target " << t);
        const auto& [first, end, stride] = rects[t];
        const reference::MeasuredTarget want =
            reference::measure_target(picture, t + 1, int(first.x), int(first.y), int(end.x), int(end.y), int(stride));
        EXPECT_EQ(got[t].pixels, uint32_t(want.pixels));
        EXPECT_EQ(got[t].inner, uint32_t(want.inner));
        EXPECT_EQ(got[t].around, uint32_t(want.around));
        // 2e-6: an invocation sums up to 16 floats, the tree of 256 takes 8 more roundings.
        const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 2e-6 * std::abs(b)); };
        near(double(got[t].solid_angle), want.solid_angle);
        near(double(got[t].luminance), want.luminance);
        near(double(got[t].around_scene), want.around_scene);
        near(double(got[t].around_retina), want.around_retina);
        if (want.pixels == 0) continue;
        near(double(got[t].centre.x), want.centre.x), near(double(got[t].centre.y), want.centre.y);
    }
}

gpu_scene::View looking(VkExtent2D extent) {
    gpu_scene::View view{.extent = extent};
    view.tangent_low = {-0.9f, -0.4f}, view.tangent_high = {0.5f, 0.6f};
    return view;
}

// All of the picture, a part of it, and nothing.
std::vector<shared::TargetRect> rects_in(VkExtent2D e) {
    return {render::target_rect({0, 0}, {e.width, e.height}, e),
            render::target_rect({0.3 * e.width, 0.2 * e.height}, {0.6 * e.width, 0.8 * e.height}, e),
            {{e.width / 2, e.height / 2}, {e.width / 2, e.height / 2}, 1}};
}

TEST(Targets, MatchTheReferenceAtEverySize) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {131, 67}, {257, 193}}) {
        const Case c(extent, extent.width);
        const auto rects = rects_in(extent);
        expect_measured(c, looking(extent), rects, measure(rig, c, looking(extent), rects));
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Sources are brighter than 300 cd/m^2 by night, and than a hundred times the log average by day.
TEST(Targets, SourcesAreThoseOfTheReferenceByNightAndByDay) {
    PassRig rig;
    for (const float most : {0.01f, 20.0f, 2000.0f}) {
        const Case c({131, 67}, 9, most);
        const auto rects = rects_in(c.extent);
        expect_measured(c, looking(c.extent), rects, measure(rig, c, looking(c.extent), rects));
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Targets, WhatIsNotFiniteDoesNotCount) {
    PassRig rig;
    Case c({61, 47}, 3);
    for (size_t i = 5; i < c.scene.size(); i += 11) c.scene[i].g = std::numeric_limits<float>::quiet_NaN();
    for (size_t i = 7; i < c.scene.size(); i += 13) c.retina[i].r = std::numeric_limits<float>::infinity();
    const auto rects = rects_in(c.extent);
    expect_measured(c, looking(c.extent), rects, measure(rig, c, looking(c.extent), rects));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Targets, AreTheSameFromRunToRun) {
    PassRig rig;
    const Case c({131, 67}, 5);
    const auto rects = rects_in(c.extent);
    const auto first = measure(rig, c, looking(c.extent), rects), again = measure(rig, c, looking(c.extent), rects);
    EXPECT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof first[0]), 0);
}

TEST(Targets, ARectangleHasAFrameOfHalfItsShorterSide) {
    const VkExtent2D picture{100, 80};
    const shared::TargetRect rect = render::target_rect({20.5, 30}, {30, 60.2}, picture);
    EXPECT_EQ(rect.first, glm::uvec2(15, 25));
    EXPECT_EQ(rect.end, glm::uvec2(35, 66));
    EXPECT_EQ(rect.stride, 1u);
    EXPECT_EQ(render::target_rect({50, 40}, {51, 41}, picture).first, glm::uvec2(48, 38)) << "2 px at least";
    EXPECT_EQ(render::target_rect({-5, -5}, {5, 5}, picture).first, glm::uvec2(0));
    EXPECT_EQ(render::target_rect({-5, -5}, {5, 5}, picture).end, glm::uvec2(10));
    const auto empty = [&](dvec2 low, dvec2 high) {
        const shared::TargetRect none = render::target_rect(low, high, picture);
        return none.first == none.end;
    };
    EXPECT_TRUE(empty({-9, 10}, {-1, 20})) << "beside it, although its frame is not";
    EXPECT_TRUE(empty({101, 10}, {120, 20}));
    EXPECT_TRUE(empty(dvec2(std::nan("")), dvec2(20)));
    const shared::TargetRect large = render::target_rect({-1e30, -1e30}, {1e30, 1e30}, {4000, 3000});
    EXPECT_EQ(large.end, glm::uvec2(4000, 3000));
    EXPECT_EQ(large.stride, 55u);  // 73 x 55 = 4,015 px are read; of every 54th, 75 x 56 = 4,200 were too many
}

TEST(Targets, WithoutAnyThereIsNoPassAndTooManyAreRefused) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{8, 8});
    EXPECT_EQ(render::add_targets(frame, {}, {}), graph::Resource{});
    EXPECT_TRUE(graph.passes().empty());
    const std::vector<shared::TargetRect> many(65, {{0, 0}, {8, 8}, 1});
    EXPECT_THROW(render::add_targets(frame, {}, {{}, many}), Error);
}

}  // namespace
}  // namespace vesper::test::targets_test
