// Small emitters on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/small_emitters_reference.h"

#include <cstring>
#include <random>

#include "render/passes/small_emitters.h"
#include "support/seen_picture.h"
#include "support/shading.h"

namespace vesper::test::small_emitters_test {
namespace {

using gpu_scene::View;
using scene::Scene;

struct Drawn {
    gpu_scene::SmallEmitterList list;
    reference::SeenPicture seen;
    std::vector<glm::vec4> got;
};

Drawn draw(PassRig& rig, const Scene& scene, const View& view, const std::vector<glm::vec4>& before) {
    const gpu_scene::GpuScene resident(rig.device(), scene);
    const gpu_scene::SceneFrame frame{scene::world_transforms(scene, 0)};
    Drawn drawn{gpu_scene::small_emitter_list(gpu_scene::emitting_parts(scene), resident, frame, view), {}, {}};
    graph::FrameGraph graph;
    const render::FrameContext context = rig.frame(graph, view);
    const render::GBuffer g = render::add_gbuffer(context, resident, frame, drawn.list.parts);
    const graph::Resource light = rig.image(graph, "scene", render::kSceneFormat, view.extent, before);
    EXPECT_EQ(render::add_small_emitters(context, g, light, drawn.list), light);
    const graph::Resource triangles = keep<glm::uvec2>(graph, g.triangle), surfaces = keep<glm::vec4>(graph, g.surface),
                          instances = keep<shared::Instance>(graph, g.instances), kept = keep<glm::vec4>(graph, light);
    rig.run(graph);
    drawn.got = rig.got<glm::vec4>(kept);
    drawn.seen = seen_picture(scene, view, rig.got<glm::uvec2>(triangles), rig.got<glm::vec4>(surfaces),
                              rig.got<shared::Instance>(instances), before, double(rig.device().anisotropy()));
    return drawn;
}

/// Compares the pixels of which no point is in doubt, as in edges_test.cpp; returns how many of those hold an emitter.
size_t expect_reference(const Drawn& drawn, const std::vector<glm::vec4>& before) {
    const std::vector<reference::SmallTriangle> triangles = reference::triangles_of(drawn.list);
    size_t compared = 0, wrong = 0;
    for (int y = 0; y < drawn.seen.size.y; ++y)
        for (int x = 0; x < drawn.seen.size.x; ++x) {
            const size_t at = size_t(y) * size_t(drawn.seen.size.x) + size_t(x);
            const reference::Emitted want = reference::emitted(triangles, drawn.seen, {x, y});
            if (want.doubt < 1e-3) continue;
            if (want.luminance.g > 0) ++compared;
            for (int c = 0; c < 3; ++c) {
                const double added = double(drawn.got[at][c]) - double(before[at][c]);
                // Areas of some triangles, each to 2e-6 px of at most 2,000 cd/m^2, added to at most 10 cd/m^2.
                if (std::abs(added - want.luminance[c]) > 1e-2 + 1e-5 * want.luminance[c] && ++wrong < 5)
                    ADD_FAILURE() << x << ", " << y << ", channel " << c << ": " << added << ", want "
                                  << want.luminance[c] << ", doubt " << want.doubt;
            }
        }
    EXPECT_EQ(wrong, 0u) << "of " << compared;
    return compared;
}

/// Clutter with lanterns and signs in it: squares that emit, some behind crosses of bars, some slanted, some mirrored.
Scene street(uint32_t seed, float emission = 1000) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    Scene scene = clutter(seed);
    const uint32_t red = add_material(scene, 0), green = add_material(scene, 0);
    scene.materials[red].emission = emission * glm::vec3(2, 0.5f, 0.1f);
    scene.materials[green].emission = emission * glm::vec3(0.2f, 1, 0.6f);
    for (int i = 0; i < 60; ++i) {
        const uint32_t glass = i % 4 < 2 ? red : green;
        const float size = 0.3f * std::pow(10.0f, 0.5f * unit(random));
        const glm::vec3 along = size * glm::normalize(glm::vec3(1, 0.4f * unit(random), unit(random))),
                        up = size * glm::vec3(0, 1, 0);
        add_rectangle(scene, glass, -0.5f * (along + up), along, up);
        if (i % 2) {  // its bars, in the same mesh
            const glm::vec3 out = 0.05f * size * glm::normalize(glm::cross(along, up));
            Scene bars;
            add_rectangle(bars, 0, out - 0.5f * up - 0.1f * along, 0.2f * along, up);
            add_rectangle(bars, 0, out - 0.5f * along - 0.1f * up, along, 0.2f * up);
            for (const scene::Mesh& bar : bars.meshes) scene.meshes.back().primitives.push_back(bar.primitives[0]);
        }
        scene::Node& node = scene.nodes.back();
        node.translation = {10 * unit(random), 5 * unit(random), -12 + 8 * unit(random)};
        if (i % 3 == 0) node.scale = {-1, 1, -1};
    }
    // Blinds: strips of a seventh of a pixel, three in one place, which are drawn wider than they are.
    for (int i = 0; i < 60; ++i)
        add_rectangle(scene, i % 2 ? red : green, {-2, 0.02f * float(i / 3), -8}, {0.6f, 0, 0}, {0, 0.02f, 0});
    return scene;
}

std::vector<glm::vec4> lights(VkExtent2D extent) {
    std::vector<glm::vec4> light;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i)
        light.emplace_back(float(i % 11), float(i % 7), float(i % 5), 1);
    return light;
}

TEST(SmallEmitters, MatchTheReference) {
    PassRig rig;
    size_t compared = 0;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 33}, {131, 67}})
        for (uint32_t seed : {1u, 2u}) {
            SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
            const View view = View::symmetric(extent, 1.1f, glm::dmat4(1));
            compared += expect_reference(draw(rig, street(seed), view, lights(extent)), lights(extent));
        }
    EXPECT_GT(compared, 100u);
    EXPECT_EQ(rig.complaints(), "");
}

/// Area of a polygon, by its corners.
double area_of(const std::vector<glm::dvec2>& v) {
    double twice = 0;
    for (size_t i = 0; i < v.size(); ++i) {
        const glm::dvec2 a = v[i], b = v[(i + 1) % v.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

// Of a closed box whose six sides glow in six colours the eye sees the sides that face it, each by its area in the
// image, however the box is mirrored.
TEST(SmallEmitters, MirroredGlowingBoxesShineAsOthersDo) {
    PassRig rig;
    const VkExtent2D extent{48, 40};
    const View view = View::symmetric(extent, 0.5f, glm::dmat4(1));
    const std::vector<glm::vec4> black(size_t(extent.width) * extent.height, {0, 0, 0, 1});
    for (const glm::dvec3 scale : {glm::dvec3(1), {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}, {-1, 1, -1}}) {
        SCOPED_TRACE(std::to_string(scale.x) + " " + std::to_string(scale.y) + " " + std::to_string(scale.z));
        Scene box, scene;
        add_box(box, add_material(box, 0), {0.3f, 0.25f, 0.2f}, {0.1f, 0, 0});
        scene.meshes.emplace_back();
        for (size_t i = 0; i < 6; ++i) {
            scene.meshes[0].primitives.push_back(box.meshes[i].primitives[0]);
            scene.meshes[0].primitives[i].material = add_material(scene, 0);
            scene.materials[i].emission = 100.0f * glm::vec3(1 + i % 2, 1 + i % 3, 6 - float(i));
        }
        scene::Node& node = scene.nodes.emplace_back();
        node.mesh = 0, node.translation = {0.9, -0.7, -6}, node.scale = scale;
        node.rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(0.3f, 1, 0.2f)));
        const glm::dmat4 world = scene::world_transforms(scene, 0)[0];
        const glm::dvec3 middle(world * glm::dvec4(0.1, 0, 0, 1));
        glm::dvec3 want(0);  // cd/m^2 px
        for (size_t i = 0; i < 6; ++i) {
            const auto& v = scene.meshes[0].primitives[i].vertices;
            std::vector<glm::dvec2> corners;
            glm::dvec3 centre(0);
            for (const scene::Vertex& vertex : v) {
                const glm::dvec3 at(world * glm::dvec4(vertex.position, 1));
                centre += at / 4.0;
                corners.push_back((glm::dvec2(at) / -at.z - glm::dvec2(view.ray_offset())) /
                                  glm::dvec2(view.ray_scale()));
            }
            // A side of a box faces away from its middle.
            const glm::dvec3 a(world * glm::dvec4(v[0].position, 1)), b(world * glm::dvec4(v[1].position, 1)),
                c(world * glm::dvec4(v[2].position, 1));
            glm::dvec3 out = glm::cross(b - a, c - a);
            if (glm::dot(out, centre - middle) < 0) out = -out;
            if (glm::dot(out, centre) < 0) want += glm::dvec3(scene.materials[i].emission) * area_of(corners);
        }
        const Drawn drawn = draw(rig, scene, view, black);
        glm::dvec3 got(0);
        for (const glm::vec4& pixel : drawn.got) got += glm::dvec3(pixel);
        // Of 16 points of a pixel some more or fewer are hidden by the sides beside.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / want[c], 1, 0.03) << c;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// NaN of one pixel stays there; other pixels keep their bits.
TEST(SmallEmitters, WhatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const VkExtent2D extent{65, 33};
    const View view = View::symmetric(extent, 1.1f, glm::dmat4(1));
    std::vector<glm::vec4> light = lights(extent);
    const Drawn clean = draw(rig, street(1), view, light);
    for (const size_t i : {700u, 1000u, 1100u}) light[i].g = std::numeric_limits<float>::quiet_NaN();
    const Drawn got = draw(rig, street(1), view, light);
    for (size_t i = 0; i < light.size(); ++i)
        if (!std::isnan(light[i].g)) {
            EXPECT_EQ(got.got[i], clean.got[i]) << i;
        }
    const Drawn again = draw(rig, street(1), view, light);
    EXPECT_EQ(std::memcmp(again.got.data(), got.got.data(), light.size() * sizeof(glm::vec4)), 0);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(SmallEmitters, WithoutThemThereIsNoPass) {
    expect_no_pass([&](const render::FrameContext& frame, graph::Resource luminance) {
        return render::add_small_emitters(frame, {}, luminance, {});
    });
}

// Their emission is not in the G-buffer, and that of others is.
TEST(SmallEmitters, AreLeftOutOfTheGBuffer) {
    PassRig rig;
    const VkExtent2D extent{65, 33};
    const View view = View::symmetric(extent, 1.1f, glm::dmat4(1));
    Scene scene;
    const uint32_t glass = add_material(scene, 0, 1000);
    add_rectangle(scene, glass, {-2, -1, -10}, {1, 0, 0}, {0, 1, 0});
    add_rectangle(scene, glass, {1, -4, -10}, {8, 0, 0}, {0, 8, 0});
    const gpu_scene::GpuScene resident(rig.device(), scene);
    const gpu_scene::SceneFrame frame{scene::world_transforms(scene, 0)};
    const auto list = gpu_scene::small_emitter_list(gpu_scene::emitting_parts(scene), resident, frame, view);
    EXPECT_EQ(list.parts, std::vector<uint32_t>{0});
    graph::FrameGraph graph;
    const render::GBuffer g = render::add_gbuffer(rig.frame(graph, view), resident, frame, list.parts);
    const graph::Resource emission = keep<glm::vec4>(graph, g.emission), surface = keep<glm::vec4>(graph, g.surface);
    rig.run(graph);
    const auto emitted = rig.got<glm::vec4>(emission), surfaces = rig.got<glm::vec4>(surface);
    size_t small = 0;
    for (size_t i = 0; i < emitted.size(); ++i) {
        EXPECT_EQ(emitted[i].g, i % 65 > 32 && surfaces[i].z > 0 ? 1000 : 0) << i;
        small += i % 65 < 32 && surfaces[i].z > 0;
    }
    EXPECT_GT(small, 4u) << "it is drawn";
    EXPECT_EQ(rig.complaints(), "");
}

// A tile's silhouettes are bounded: those beyond stay in the G-buffer. So do those that are large, or behind the eye.
TEST(SmallEmitters, AreAsManyAsATileTakes) {
    PassRig rig;
    const View view = View::symmetric({65, 33}, 1.1f, glm::dmat4(1));
    Scene scene;
    const uint32_t glass = add_material(scene, 0, 1000);
    for (uint32_t i = 0; i < gpu_scene::kMostSmallEmittersOfTile; ++i)
        add_rectangle(scene, glass, {0, 0, -100}, {0.1f, 0, 0}, {0, 0.1f, 0});
    add_rectangle(scene, glass, {-2, -2, -1}, {1, 0, 0}, {0, 1, 0});
    add_rectangle(scene, glass, {0, 0, 10}, {1, 0, 0}, {0, 1, 0});
    const gpu_scene::GpuScene resident(rig.device(), scene);
    const auto parts = gpu_scene::emitting_parts(scene);
    gpu_scene::SceneFrame frame{scene::world_transforms(scene, 0)};
    const auto list = gpu_scene::small_emitter_list(parts, resident, frame, view);
    EXPECT_EQ(list.emitters.size(), gpu_scene::kMostSmallEmittersOfTile) << "two triangles each";
    EXPECT_EQ(list.parts.size(), gpu_scene::kMostSmallEmittersOfTile / 2);
    for (const glm::uvec4& tile : list.tiles) EXPECT_LE(tile.w, gpu_scene::kMostSmallEmittersOfTile);
    frame.dimming.assign(scene.nodes.size(), 0.5f);
    EXPECT_EQ(gpu_scene::small_emitter_list(parts, resident, frame, view).emitters[0].luminance,
              0.5f * list.emitters[0].luminance);
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::small_emitters_test
