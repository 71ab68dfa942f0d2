// Pixels beside edges on the device against their reference. SPDX-License-Identifier: MIT
#include "passes/edges_reference.h"

#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "gpu_scene/facets.h"
#include "gpu_scene/leading_vertices.h"
#include "passes/shade_reference.h"
#include "render/passes/edges.h"
#include "shared/gbuffer.h"
#include "support/rooms.h"
#include "support/shading.h"

namespace vesper::test::edges_test {
namespace {

using gpu_scene::View;
using scene::Scene;

/// What each vertex of the device leads, in its mesh's frame.
std::vector<std::vector<glm::dvec3>> facets_on_the_device(const Scene& scene) {
    std::vector<std::vector<glm::dvec3>> all;
    for (const scene::Mesh& mesh : scene.meshes)
        for (const scene::Primitive& primitive : mesh.primitives) {
            const gpu_scene::LeadingVertices leading(primitive);
            const std::vector<gpu_scene::Facet> facets = gpu_scene::facets(primitive);
            const size_t first = all.size();
            all.resize(first + leading.vertices().size());
            for (size_t i = 0; i < facets.size(); ++i)
                for (uint32_t k = 0; k < facets[i].count; ++k)
                    all[first + leading.indices()[3 * i]].emplace_back(
                        primitive.vertices[facets[i].corners[k]].position);
        }
    return all;
}

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
    render::add_edges(context, resident, g, light);
    const graph::Resource triangles = keep<glm::uvec2>(graph, g.triangle), surfaces = keep<glm::vec4>(graph, g.surface),
                          instances = keep<shared::Instance>(graph, g.instances), kept = keep<glm::vec4>(graph, light);
    rig.run(graph);

    Edged edged{{glm::ivec2(view.extent.width, view.extent.height),
                 glm::dvec2(view.ray_scale()),
                 glm::dvec2(view.ray_offset()),
                 {},
                 {}},
                rig.got<glm::vec4>(kept)};
    const auto facets = facets_on_the_device(scene);
    const auto seen = rig.got<glm::uvec2>(triangles);
    const auto surface = rig.got<glm::vec4>(surfaces);
    const auto rows = rig.got<shared::Instance>(instances);
    for (size_t i = 0; i < seen.size(); ++i) {
        reference::SeenFacet& facet = edged.seen.facets.emplace_back();
        edged.seen.luminance.emplace_back(glm::vec3(luminance[i]));
        facet.instance = seen[i].x;
        if (seen[i].x == 0) continue;
        facet.triangle = seen[i].y;
        const shared::Instance& instance = rows[seen[i].x - 1];
        for (const glm::dvec3& corner : facets.at(seen[i].y)) {
            const glm::dvec4 p(corner, 1);
            facet.corners.emplace_back(glm::dot(glm::dvec4(instance.row_x), p), glm::dot(glm::dvec4(instance.row_y), p),
                                       glm::dot(glm::dvec4(instance.row_z), p));
        }
        const glm::dvec2 middle = glm::dvec2(i % view.extent.width, i / view.extent.width) + 0.5;
        facet.normal = reference::octahedral_decode({surface[i].x, surface[i].y});
        facet.position = double(surface[i].z) * glm::dvec3(edged.seen.scale * middle + edged.seen.offset, -1);
        facet.masked = instance.masked != 0;
    }
    return edged;
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

/// Boxes and sheets of all sizes and turns before a wall and the sky, some mirrored, some with holes, some beside and
/// behind the eye.
Scene clutter(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    Scene scene;
    add_material(scene, 0.5f);
    scene.materials[0].double_sided = true;
    scene.images = {{"", 8, 8, {}}};
    for (int i = 0; i < 64; ++i)
        scene.images[0].rgba.insert(scene.images[0].rgba.end(), {200, 200, 200, uint8_t(random() % 256)});
    add_material(scene, 0.5f);
    scene.materials[1].alpha = scene::Material::Alpha::Mask, scene.materials[1].alpha_cutoff = 0.5f;
    scene.materials[1].base_colour_texture.image = 0, scene.materials[1].double_sided = true;
    add_rectangle(scene, 0, {-30, -30, -40}, {60, 0, 0}, {0, 40, 0});
    add_rectangle(scene, 0, {-30, -3, 20}, {60, 0, 0}, {0, 0, -60});  // a road under the eye, and behind it
    for (int i = 0; i < 30; ++i) {
        const float size = std::pow(10.0f, unit(random));
        const glm::vec3 place(12 * unit(random), 8 * unit(random), -14 + 12 * unit(random));
        if (i % 3 == 0)
            add_rectangle(scene, i % 2, place, size * glm::vec3(unit(random), unit(random), unit(random)),
                          size * glm::vec3(unit(random), unit(random), unit(random)));
        else
            add_box(scene, 0, size * glm::vec3(0.1f, 1, 0.3f), glm::vec3(0));
        for (size_t n = scene.nodes.size() - 6; i % 3 != 0 && n < scene.nodes.size(); ++n)
            scene.nodes[n].translation = place, scene.nodes[n].scale = {i % 2 ? -1.0 : 1.0, 1.0, 1.0};
    }
    for (scene::Mesh& mesh : scene.meshes)
        for (scene::Primitive& p : mesh.primitives)
            for (size_t k = 0; k < p.vertices.size(); ++k) p.vertices[k].uv = {float(k % 2), float(k / 2)};
    return scene;
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
        render::add_edges(frame, empty, {}, luminance);
        return luminance;
    });
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::edges_test
