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
Edged draw(PassRig& rig, const Scene& scene, const View& view, const std::vector<glm::vec4>& luminance,
           uint32_t points = reference::kPixelPoints) {
    const gpu_scene::GpuScene resident(rig.device(), scene);
    const gpu_scene::SceneFrame frame{scene::world_transforms(scene, 0)};
    graph::FrameGraph graph;
    const render::FrameContext context = rig.frame(graph, view);
    const render::GBuffer g = render::add_gbuffer(context, resident, frame);
    const graph::Resource light = rig.image(graph, "scene", render::kSceneFormat, view.extent, luminance);
    render::add_edges(context, g, light, points);
    const graph::Resource triangles = keep<glm::uvec2>(graph, g.triangle), surfaces = keep<glm::vec4>(graph, g.surface),
                          instances = keep<shared::Instance>(graph, g.instances), kept = keep<glm::vec4>(graph, light);
    rig.run(graph);

    Edged edged{seen_picture(scene, view, rig.got<glm::uvec2>(triangles), rig.got<glm::vec4>(surfaces),
                             rig.got<shared::Instance>(instances), luminance, double(rig.device().anisotropy())),
                rig.got<glm::vec4>(kept)};
    edged.seen.points = points;
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
            for (int c = 0; c < 3; ++c) {
                double most = 0;
                for (const glm::ivec2 q : reference::neighbourhood({x, y}))
                    if (seen.has(q)) most = std::max(most, seen.light(q)[c]);
                if (std::abs(double(got[c]) - want.luminance[c]) > 1e-5 * most && ++wrong < 5)
                    ADD_FAILURE() << x << ", " << y << ", channel " << c << ": " << got[c] << ", want "
                                  << want.luminance[c] << " of at most " << most << ", doubt " << want.doubt;
            }
        }
    EXPECT_EQ(wrong, 0u) << "of " << compared;
    return edges == 0 ? 0 : double(compared) / double(edges);
}

std::vector<glm::vec4> lights(VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> exponent(-3, 4);
    std::vector<glm::vec4> light;
    const auto value = [&] { return std::pow(10.0f, exponent(random)); };
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const float red = value(), green = value(), blue = value();
        light.emplace_back(red, green, blue, 1);
    }
    return light;
}

/// One colour, but that one channel of a pixel is up to 5 % more.
std::vector<glm::vec4> even_lights(VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> more(1, 1.05f);
    std::vector<glm::vec4> light(size_t(extent.width) * extent.height, {3, 20, 0.5f, 1});
    for (glm::vec4& pixel : light) pixel[int(random() % 3)] *= more(random);
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

TEST(Edges, MatchTheReferenceAtFewerPoints) {
    PassRig rig;
    const VkExtent2D extent{131, 67};
    const View view = View::symmetric(extent, 1.1f, glm::rotate(glm::dmat4(1), 0.1, {0, 1, 0}));
    const std::vector<glm::vec4> all = draw(rig, clutter(1), view, lights(extent, 1)).got;
    for (const uint32_t points : {4u, 5u, 8u, 11u}) {
        SCOPED_TRACE(points);
        const Edged edged = draw(rig, clutter(1), view, lights(extent, 1), points);
        EXPECT_GT(expect_reference(edged), 0.4);
        EXPECT_NE(edged.got, all);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Edges, ContrastsOfTwoPercentInAnyChannelAreSeen) {
    PassRig rig;
    const VkExtent2D extent{131, 67};
    const View view = View::symmetric(extent, 1.1f, glm::dmat4(1));
    for (uint32_t seed : {1u, 2u})
        EXPECT_GT(expect_reference(draw(rig, clutter(seed), view, even_lights(extent, seed))), 0.4);
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

/// Boards with holes, near and far, at all turns and in all ways that textures wrap, before a wall.
Scene boards(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    Scene scene;
    add_material(scene, 0.5f);
    scene.images = {{"", 37, 21, {}}, {"", 1, 16, {}}};
    for (uint32_t i = 0; i < 37 * 21; ++i) {
        const bool solid = (i % 37 / 4 + i / 37 / 4 * 3) % 4 != 0;
        scene.images[0].rgba.insert(scene.images[0].rgba.end(),
                                    {200, 200, 200, uint8_t(solid ? 255 - random() % 90 : random() % 60)});
    }
    for (uint32_t i = 0; i < 16; ++i)
        scene.images[1].rgba.insert(scene.images[1].rgba.end(), {200, 200, 200, uint8_t(i % 5 == 0 ? 0 : 255)});
    add_rectangle(scene, 0, {-30, -30, -40}, {60, 0, 0}, {0, 60, 0});
    constexpr scene::Wrap kWraps[]{scene::Wrap::Repeat, scene::Wrap::Mirror, scene::Wrap::Clamp, scene::Wrap::Repeat};
    for (size_t wrap = 0; wrap < 3; ++wrap)
        for (const bool nearest : {false, true}) {
            const uint32_t material = add_material(scene, 0.5f);
            scene::Material& m = scene.materials[material];
            m.alpha = scene::Material::Alpha::Mask, m.alpha_cutoff = 0.45f, m.base_colour.a = 0.9f,
            m.double_sided = true;
            m.base_colour_texture = {uint32_t(wrap == 1 ? 1 : 0), kWraps[wrap], kWraps[wrap + 1], nearest};
            for (int i = 0; i < 5; ++i) {
                const float size = 3 * std::pow(4.0f, unit(random)), scale = 1.5f + unit(random);
                const glm::vec3 along(unit(random), unit(random), unit(random)),
                    up(unit(random), unit(random), unit(random));
                add_rectangle(scene, material, {5 * unit(random), 3 * unit(random), -12 + 9 * unit(random)},
                              size * along, size * up);
                scene::Primitive& board = scene.meshes.back().primitives[0];
                const std::vector<glm::vec2> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                for (size_t k = 0; k < 4; ++k) board.vertices[k].uv = scale * corners[k] - 0.3f;
            }
        }
    return scene;
}

TEST(Edges, HolesMatchTheReference) {
    PassRig rig;
    const VkExtent2D extent{131, 67};
    for (const uint32_t seed : {1u, 2u, 3u}) {
        SCOPED_TRACE(seed);
        const View view = View::symmetric(extent, 1.1f, glm::rotate(glm::dmat4(1), 0.1 * seed, {0, 1, 0}));
        EXPECT_GT(expect_reference(draw(rig, boards(seed), view, lights(extent, seed))), 0.3);
    }
    EXPECT_EQ(rig.complaints(), "");
}

/// The part of pixel 8 that shows what is left of it.
double left_part(PassRig& rig, const Scene& wall) {
    std::vector<glm::vec4> light;
    for (uint32_t i = 0; i < 256; ++i) light.emplace_back(glm::vec3(i % 16 < 8 ? 1.0f : 3.0f), 1);
    const Edged edged = draw(rig, wall, View::symmetric({16, 16}, 1, glm::dmat4(1)), light);
    return (3 - double(edged.got[7 * 16 + 8].r)) / 2;
}

/// Two halves of a wall at 10 m that meet at a quarter of pixel 8: one mesh, of given normals, the right one farther by
/// `step` and turned away by `bend`.
Scene two_halves(glm::vec3 left, glm::vec3 right, float step, float bend = 0) {
    Scene wall, half;
    add_rectangle(wall, add_material(wall, 0.5f), {-9, -9, -10}, {9.17f, 0, 0}, {0, 18, 0});
    add_rectangle(half, 0, {0.17f, -9, -10 - step}, {9 * std::cos(bend), 0, -9 * std::sin(bend)}, {0, 18, 0});
    scene::Primitive& p = wall.meshes[0].primitives[0];
    for (scene::Vertex& vertex : p.vertices) vertex.normal = left;
    for (scene::Vertex vertex : half.meshes[0].primitives[0].vertices) {
        vertex.normal = right;
        p.vertices.push_back(vertex);
        p.bounds.add(vertex.position);
    }
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(4 + i);
    return wall;
}

/// Whether pixel 8 shows a part of the left half, which is seen through red and blue glass.
bool shows_an_edge(PassRig& rig, const Scene& wall) {
    const VkExtent2D extent{16, 16};
    std::vector<glm::vec4> light;
    for (uint32_t i = 0; i < 256; ++i) light.push_back(i % 16 < 8 ? glm::vec4(1, 3, 7, 1) : glm::vec4(3, 3, 5, 1));
    const Edged edged = draw(rig, wall, View::symmetric(extent, 1, glm::dmat4(1)), light);
    const glm::vec3 got(edged.got[7 * 16 + 8]);
    const bool edge = reference::is_edge(edged.seen, {8, 7});
    const glm::vec3 want = edge ? glm::vec3(2.5f, 3, 5.5f) : glm::vec3(3, 3, 5);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 2e-6f) << c;
    return got.r < 2.9f;
}

// A wall before a farther one, whose level border is a quarter into the pixels beyond it.
TEST(Edges, LevelBordersAreSeenFromAboveAndFromBelow) {
    PassRig rig;
    for (const bool low : {false, true}) {
        SCOPED_TRACE(low);
        Scene walls;
        const uint32_t material = add_material(walls, 0.5f);
        add_rectangle(walls, material, {-9, low ? -9 : -0.17f, -10}, {18, 0, 0}, {0, 9.17f, 0});
        add_rectangle(walls, material, {-9, -9, -10.5f}, {18, 0, 0}, {0, 18, 0});
        std::vector<glm::vec4> light;
        for (uint32_t i = 0; i < 256; ++i)
            light.push_back((i / 16 < 8) == low ? glm::vec4(3, 3, 5, 1) : glm::vec4(1, 3, 7, 1));
        const Edged edged = draw(rig, walls, View::symmetric({16, 16}, 1, glm::dmat4(1)), light);
        const uint32_t row = low ? 7 : 8;
        for (uint32_t x = 1; x < 15; ++x) EXPECT_NEAR(edged.got[16 * row + x].r, 2.5f, 2e-6f) << x;
        EXPECT_EQ(edged.got[16 * (15 - row) + 7].r, 1);
    }
    EXPECT_EQ(rig.complaints(), "");
}

const glm::vec3 kAhead(0, 0, 1);
glm::vec3 turned(float angle) { return {std::sin(angle), 0, std::cos(angle)}; }

// By less or by more than rounding explains, 2 mm.
TEST(Edges, AStepOfAWallIsOne) {
    PassRig rig;
    EXPECT_FALSE(shows_an_edge(rig, two_halves(kAhead, kAhead, 1.96e-3f)));
    EXPECT_TRUE(shows_an_edge(rig, two_halves(kAhead, kAhead, 2.04e-3f)));
    EXPECT_EQ(rig.complaints(), "");
}

// A cosine of 0.9 is 25.84 degrees.
TEST(Edges, ABendOfAWallIsOneFrom26Degrees) {
    PassRig rig;
    for (const float degrees : {25.0f, -25.0f, 26.5f, -26.5f}) {
        const float bend = glm::radians(degrees);
        EXPECT_EQ(shows_an_edge(rig, two_halves(kAhead, turned(bend), 0, bend)), std::abs(degrees) > 26) << degrees;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A step of 1 cm is less than a bend of 0.05 explains between two pixels, 3 cm, on the plane of the half that is not
// bent, and more on that of the other.
TEST(Edges, AStepIsOneOnEitherPlane) {
    PassRig rig;
    EXPECT_TRUE(shows_an_edge(rig, two_halves(turned(-0.05f), kAhead, 0.01f)));
    EXPECT_TRUE(shows_an_edge(rig, two_halves(kAhead, turned(-0.05f), 0.01f)));
    EXPECT_FALSE(shows_an_edge(rig, two_halves(turned(0.05f), kAhead, 0.01f)));
    EXPECT_FALSE(shows_an_edge(rig, two_halves(kAhead, turned(0.05f), 0.01f)));
    EXPECT_EQ(rig.complaints(), "");
}

// Normals that lean by 0.05 take pixels of one half for different surfaces, too, of which the one to the right of pixel
// 8 is brighter: it shows a quarter of the left half, though that is hardly darker.
TEST(Edges, ASurfaceThatDiffersWithinAFacetMakesAnEdgeBesideAnother) {
    PassRig rig;
    std::vector<glm::vec4> light;
    for (uint32_t i = 0; i < 256; ++i)
        light.emplace_back(glm::vec3(i % 16 < 8 ? 1.0f : i % 16 == 8 ? 1.015f : 2.0f), 1);
    const Edged edged =
        draw(rig, two_halves(turned(0.05f), turned(0.05f), 0), View::symmetric({16, 16}, 1, glm::dmat4(1)), light);
    EXPECT_TRUE(reference::is_edge(edged.seen, {8, 7}));
    EXPECT_NEAR(edged.got[7 * 16 + 8].r, 1.01125f, 1e-6f);
    EXPECT_EQ(rig.complaints(), "");
}

// Between two pixels, 0.683 m, a bend of 0.05 explains 34.2 mm, and rounding 2.0 mm.
TEST(Edges, ABendExplainsAStepAsHighAsItself) {
    PassRig rig;
    EXPECT_FALSE(shows_an_edge(rig, two_halves(kAhead, turned(0.05f), 0.0357f)));
    EXPECT_TRUE(shows_an_edge(rig, two_halves(kAhead, turned(0.05f), 0.0367f)));
    EXPECT_FALSE(shows_an_edge(rig, two_halves(turned(0.05f), kAhead, 0.0357f)));
    EXPECT_TRUE(shows_an_edge(rig, two_halves(turned(0.05f), kAhead, 0.0367f)));
    EXPECT_EQ(rig.complaints(), "");
}

// In one plane of one mesh, a border of colour a quarter into pixel 8.
TEST(Edges, BordersOfColourAreSeen) {
    PassRig rig;
    Scene wall = two_halves(kAhead, kAhead, 0);
    EXPECT_EQ(left_part(rig, wall), 0) << "one colour";
    std::vector<scene::Vertex>& vertices = wall.meshes[0].primitives[0].vertices;
    for (size_t k = 4; k < 8; ++k) vertices[k].colour = {65535, 0, 0, 65535};
    EXPECT_NEAR(left_part(rig, wall), 0.25, 1e-6);
    // A palette: each half at a texel of its own.
    for (size_t k = 0; k < 8; ++k)
        vertices[k].colour = vertices[0].colour, vertices[k].uv = {k < 4 ? 0.25f : 0.75f, 0.5f};
    EXPECT_EQ(left_part(rig, wall), 0) << "no texture is there";
    wall.images = {{"palette", 2, 1, {255, 0, 0, 255, 0, 0, 255, 255}}};
    wall.materials[0].base_colour_texture.image = 0;
    EXPECT_NEAR(left_part(rig, wall), 0.25, 1e-6);
    EXPECT_EQ(rig.complaints(), "");
}

// A board whose left half is there, 0.17 m right of the middle, before a wall.
TEST(Edges, BordersOfHolesAreSeen) {
    PassRig rig;
    enum class Holes { Known, OfVerticesToo, OfVertices };
    for (const Holes holes : {Holes::Known, Holes::OfVerticesToo, Holes::OfVertices}) {
        Scene scene;
        add_rectangle(scene, add_material(scene, 0.5f), {-18, -18, -20}, {36, 0, 0}, {0, 36, 0});
        scene.images = {{"half", 2, 1, {255, 255, 255, 255, 255, 255, 255, 0}}};
        const uint32_t board = add_material(scene, 0.5f);
        scene.materials[board].alpha = scene::Material::Alpha::Mask;
        if (holes != Holes::OfVertices)
            scene.materials[board].base_colour_texture = {0, scene::Wrap::Clamp, scene::Wrap::Clamp, true};
        add_rectangle(scene, board, {-8.83f, -9, -10}, {18, 0, 0}, {0, 18, 0});
        const std::vector<glm::vec2> corners{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        for (size_t k = 0; k < 4; ++k) {
            scene::Vertex& vertex = scene.meshes[1].primitives[0].vertices[k];
            vertex.uv = corners[k];
            // Where holes are by its vertices, too, is not known.
            if (holes != Holes::Known) vertex.colour[3] = holes == Holes::OfVertices && k % 3 != 0 ? 0 : 60000;
        }
        EXPECT_NEAR(left_part(rig, scene), holes == Holes::Known ? 0.25 : 0, 1e-6);
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
        render::add_edges(frame, {}, luminance, 16);
        return luminance;
    });
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::edges_test
