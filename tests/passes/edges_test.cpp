// Pixels beside edges on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/edges_reference.h"

#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "render/passes/edges.h"
#include "support/seen_picture.h"
#include "support/shading.h"

namespace vesper::test::edges_test {
namespace {

using gpu_scene::View;
using scene::Scene;

struct Edged {
    reference::SeenPicture seen;
    std::vector<glm::vec4> got;
};

/// Draws a scene, and puts made-up luminances on it.
Edged draw(PassRig& rig, const Scene& scene, const View& view, const std::vector<glm::vec4>& luminance) {
    const gpu_scene::GpuScene resident(rig.device(), scene);
    const gpu_scene::SceneFrame frame{scene::world_transforms(scene, 0)};
    graph::FrameGraph graph;
    const render::FrameContext context = rig.frame(graph, view);
    const render::GBuffer g = render::add_gbuffer(context, resident, frame);
    const graph::Resource light = rig.image(graph, "scene", render::kSceneFormat, view.extent, luminance);
    render::add_edges(context, g, light);
    const graph::Resource triangles = keep<glm::uvec2>(graph, g.triangle), surfaces = keep<glm::vec4>(graph, g.surface),
                          instances = keep<shared::Instance>(graph, g.instances), kept = keep<glm::vec4>(graph, light);
    rig.run(graph);

    return {seen_picture(scene, view, rig.got<glm::uvec2>(triangles), rig.got<glm::vec4>(surfaces),
                         rig.got<shared::Instance>(instances), luminance),
            rig.got<glm::vec4>(kept)};
}

/// Compares all pixels. Returns the share of those beside edges of which no point is in doubt: on a line of a facet to
/// 1/1000 px, which float does not place, or before another facet by 1e-6 of its depth.
double expect_reference(const Edged& edged) {
    const reference::SeenPicture& seen = edged.seen;
    size_t edges = 0, compared = 0, wrong = 0;
    for (int y = 0; y < seen.size.y; ++y)
        for (int x = 0; x < seen.size.x; ++x) {
            const glm::vec4 got = edged.got[size_t(y) * size_t(seen.size.x) + size_t(x)];
            if (!reference::is_edge(seen, {x, y})) {
                EXPECT_EQ(glm::vec3(got), glm::vec3(seen.light({x, y}))) << x << ", " << y << ": one surface";
                continue;
            }
            ++edges;
            const reference::EdgeMean want = reference::edge_mean(seen, {x, y});
            if (want.doubt < 1e-3) continue;
            ++compared;
            double most = 0;
            for (const glm::ivec2 q : reference::neighbourhood({x, y}))
                if (seen.has(q)) most = std::max(most, seen.light(q).g);
            if (std::abs(double(got.g) - want.luminance.g) > 1e-5 * most && ++wrong < 5)
                ADD_FAILURE() << x << ", " << y << ": " << got.g << ", want " << want.luminance.g << " of at most "
                              << most << ", doubt " << want.doubt;
        }
    EXPECT_EQ(wrong, 0u) << "of " << compared;
    return edges == 0 ? 0 : double(compared) / double(edges);
}

std::vector<glm::vec4> lights(VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> exponent(-3, 4);
    std::vector<glm::vec4> light;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i)
        light.emplace_back(glm::vec3(std::pow(10.0f, exponent(random))), 1);
    return light;
}

TEST(Edges, MatchTheReference) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 33}, {131, 67}})
        for (uint32_t seed : {1u, 2u}) {
            SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
            const View view = View::symmetric(extent, 1.1f, glm::rotate(glm::dmat4(1), 0.1 * seed, {0, 1, 0}));
            const double share = expect_reference(draw(rig, clutter(seed), view, lights(extent, seed)));
            if (extent.width > 60) {
                EXPECT_GT(share, 0.4);
            }
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Edges, WhatIsNotFiniteStaysWhereItIsSeen) {
    PassRig rig;
    const VkExtent2D extent{33, 17};
    const View view = View::symmetric(extent, 1.1f, glm::dmat4(1));
    std::vector<glm::vec4> light = lights(extent, 3);
    const Edged clean = draw(rig, clutter(1), view, light);
    for (size_t i : {5u, 200u, 300u}) light[i].r = std::numeric_limits<float>::quiet_NaN();
    const Edged got = draw(rig, clutter(1), view, light);
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 33; ++x) {
            const size_t at = size_t(33 * y + x);
            bool near = false;
            for (const glm::ivec2 q : reference::neighbourhood({x, y}))
                near = near || (got.seen.has(q) && std::isnan(got.seen.light(q).r));
            if (!near) {
                EXPECT_EQ(got.got[at], clean.got[at]) << x << ", " << y;
            }
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Two halves of a wall at 10 m, one of them farther by less or by more than rounding explains (2 mm): one surface, or
// two.
TEST(Edges, AStepOfAWallIsOne) {
    PassRig rig;
    const VkExtent2D extent{16, 16};
    const View view = View::symmetric(extent, 1, glm::dmat4(1));
    for (const float step : {1.6e-3f, 2.4e-3f}) {
        Scene wall;
        add_rectangle(wall, add_material(wall, 0.5f), {-9, -9, -10}, {9.17f, 0, 0}, {0, 18, 0});
        scene::Primitive& p = wall.meshes[0].primitives[0];
        Scene half;
        add_rectangle(half, 0, {0.17f, -9, -10 - step}, {9, 0, 0}, {0, 18, 0});  // a quarter of pixel 8
        for (const scene::Vertex& vertex : half.meshes[0].primitives[0].vertices) p.vertices.push_back(vertex);
        for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(4 + i);
        p.bounds.add({9, 9, -10 - step});
        std::vector<glm::vec4> light;
        for (uint32_t i = 0; i < 256; ++i) light.emplace_back(glm::vec3(i % 16 < 8 ? 1 : 3), 1);
        const Edged edged = draw(rig, wall, view, light);
        EXPECT_EQ(reference::is_edge(edged.seen, {8, 7}), step > 2e-3f) << step;
        EXPECT_NEAR(edged.got[7 * 16 + 8].g, step > 2e-3f ? 2.5f : 3.0f, 1e-6f) << step;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Places that are no places are seen by nobody, and hide nothing.
TEST(Edges, BrokenTrianglesChangeNothing) {
    PassRig rig;
    Scene scene = clutter(2);
    const VkExtent2D extent{65, 33};
    const View view = View::symmetric(extent, 1.1f, glm::dmat4(1));
    const Edged want = draw(rig, scene, view, lights(extent, 3));
    add_rectangle(scene, 0, {0, 0, -5}, {1, 0, 0}, {0, 1, 0});
    for (scene::Vertex& vertex : scene.meshes.back().primitives[0].vertices)
        vertex.position.y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(draw(rig, scene, view, lights(extent, 3)).got, want.got);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Edges, AnEmptySceneHasNone) {
    PassRig rig;
    const gpu_scene::GpuScene empty(rig.device(), Scene{});
    expect_no_pass([&](const render::FrameContext& frame, graph::Resource luminance) {
        EXPECT_FALSE(render::has_facets(rig.device(), empty));
        render::add_edges(frame, {}, luminance);
        return luminance;
    });
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::edges_test
