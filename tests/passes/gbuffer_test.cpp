// The rasterized G-buffer against rays cast at every triangle. SPDX-License-Identifier: MIT
#include "passes/gbuffer_reference.h"

#include <algorithm>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "gpu_scene/gpu_scene.h"
#include "passes/shade_reference.h"
#include "render/passes/gbuffer.h"
#include "support/compare.h"
#include "support/scene_geometry.h"
#include "support/snapping.h"
#include "support/texels.h"

namespace vesper::test::gbuffer_test {
namespace {

using gpu_scene::View;
using scene::Material, scene::Scene, scene::Vertex, scene::Wrap;

struct Layers {
    std::vector<glm::vec4> reflectance, surface, emission;
    std::vector<uint32_t> slope;
};

Layers draw(PassRig& rig, const Scene& scene, const View& view,
            gpu_scene::PictureFormat pictures = gpu_scene::PictureFormat::Float) {
    const gpu_scene::GpuScene resident(rig.device(), scene, pictures);
    const gpu_scene::SceneFrame frame{scene::world_transforms(scene, 0)};
    graph::FrameGraph graph;
    const render::GBuffer g = render::add_gbuffer(rig.frame(graph, view), resident, frame);
    const graph::Resource reflectance = keep<uint64_t>(graph, g.reflectance),
                          surface = keep<glm::vec4>(graph, g.surface), emission = keep<glm::vec4>(graph, g.emission),
                          slope = keep<uint32_t>(graph, g.slope);
    rig.run(graph);
    return {from_halves(rig.got<uint64_t>(reflectance)), rig.got<glm::vec4>(surface), rig.got<glm::vec4>(emission),
            rig.got<uint32_t>(slope)};
}

/// How near values must be. Depth and normals are interpolated in float over triangles snapped to 1/256 px.
struct Nearness {
    double depth = 2e-5;        ///< relative; plus what a 1/256 px shift does, see slack
    double normal = 1e-4;       ///< distance of unit vectors
    double reflectance = 1e-3;  ///< absolute: half floats below 1, rounded either way
    double emission = 1e-3;     ///< relative
    reference::Filter filter = reference::Filter::Bilinear;
    double emission_floor = 1e-6;  ///< cd/m^2: of what is darker this counts, not itself
    gpu_scene::PictureFormat pictures = gpu_scene::PictureFormat::Float;
    double snap = 1.0 / 256;  ///< px, see snapped()
};

reference::Rays rays_of(const View& view) {
    return {glm::dvec2(view.ray_scale()), glm::dvec2(view.ray_offset()), view.near};
}

/// Compares every pixel whose triangle is beyond doubt, and returns how many those were.
size_t expect_reference(const Layers& got, const reference::Geometry& g, const View& view, Nearness near = {}) {
    const auto [w, h] = view.extent;
    const reference::Rays rays = rays_of(view);
    size_t compared = 0, bad = 0;
    std::string first;
    for (uint32_t y = 0; y < h; ++y)
        for (uint32_t x = 0; x < w; ++x) {
            const glm::dvec2 pixel(x + 0.5, y + 0.5);
            if (!reference::certain(g, rays, pixel, 4 * near.snap)) continue;
            ++compared;
            const reference::Seen want = reference::cast(g, rays, pixel, near.filter);
            const size_t i = size_t(y) * w + x;
            const glm::dvec4 reflectance(got.reflectance[i]), surface(got.surface[i]);
            std::string wrong;
            if (want.depth == 0) {
                if (surface.z != 0) wrong = "something is drawn over the sky";
            } else {
                // Where the surface is steep or bent, the snapping of vertices moves what is seen.
                double slack = near.depth * want.depth, turned = near.normal, coloured = near.reflectance;
                for (glm::dvec2 shift : {glm::dvec2(near.snap, 0), glm::dvec2(0, near.snap)}) {
                    const reference::Seen other = reference::cast(g, rays, pixel + shift, near.filter);
                    slack += std::abs(other.depth - want.depth);
                    turned += glm::length(other.normal - want.normal);
                    coloured += glm::length(other.base - want.base);
                }
                const glm::dvec3 normal = reference::octahedral_decode({surface.x, surface.y});
                if (!(std::abs(surface.z - want.depth) <= slack))
                    wrong += " depth " + std::to_string(surface.z) + " want " + std::to_string(want.depth);
                if (!(glm::length(normal - want.normal) <= turned))
                    wrong += " normal off by " + std::to_string(glm::length(normal - want.normal));
                for (int c = 0; c < 3; ++c) {
                    if (!(std::abs(reflectance[c] - want.base[c]) <= coloured))
                        wrong +=
                            " reflectance " + std::to_string(reflectance[c]) + " want " + std::to_string(want.base[c]);
                    if (!(std::abs(got.emission[i][c] - want.emission[c]) <=
                          near.emission * std::max(want.emission[c], near.emission_floor)))
                        wrong += " emission " + std::to_string(got.emission[i][c]) + " want " +
                                 std::to_string(want.emission[c]);
                }
                if (!(std::abs(reflectance.w - want.metallic) <= near.reflectance))
                    wrong += " metallic " + std::to_string(reflectance.w) + " want " + std::to_string(want.metallic);
                if (!(std::abs(surface.w - want.roughness) <= near.reflectance))
                    wrong += " roughness " + std::to_string(surface.w) + " want " + std::to_string(want.roughness);
            }
            if (!wrong.empty() && bad++ == 0) first = "(" + std::to_string(x) + ", " + std::to_string(y) + "):" + wrong;
        }
    // Where clipping is as coarse as snapping, single pixels beside what reaches behind the eye.
    EXPECT_LE(bad, near.snap > 1.0 / 256 ? compared / 1000 : 0) << "of " << compared << " pixels; first " << first;
    return compared;
}

size_t expect_scene(PassRig& rig, const Scene& scene, const View& view, Nearness near = {}) {
    near.snap = snapped(rig.device());
    return expect_reference(draw(rig, scene, view, near.pictures),
                            geometry_of(scene, scene::world_transforms(scene, 0), view.world_to_view), view, near);
}

View view_of(VkExtent2D extent, float fov = 0.9f) { return View::symmetric(extent, fov, glm::mat4(1)); }

Material plain(glm::vec3 colour, bool double_sided = false) {
    Material m;
    m.base_colour = glm::vec4(colour, 1), m.double_sided = double_sided;
    return m;
}

TEST(Gbuffer, ViewsMapPixelsToRays) {
    const View view = view_of({200, 100}, 1.0f);
    const reference::Rays rays = rays_of(view);
    const double top = std::tan(0.5);
    EXPECT_NEAR(glm::length(rays.at({0, 0}) - glm::dvec3(-2 * top, top, -1)), 0, 1e-6) << "the upper left corner";
    EXPECT_NEAR(glm::length(rays.at({200, 100}) - glm::dvec3(2 * top, -top, -1)), 0, 1e-6);
    const double degrees = 180 / 3.14159265358979, step = rays.at({100, 50}).y - rays.at({100, 51}).y;
    EXPECT_NEAR(view.degrees_per_pixel(), std::atan(step) * degrees, 1e-4);
}

/// Triangles of every attitude, half of them double-sided, carried by nodes that turn, stretch and mirror them.
Scene soup(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto point = [&](float r) { return r * glm::vec3(unit(random), unit(random), unit(random)); };
    Scene scene;
    scene.materials = {plain({0.8f, 0.2f, 0.1f}), plain({0.1f, 0.6f, 0.9f}, true)};
    scene.materials[1].metallic = 0.7f, scene.materials[1].roughness = 0.35f,
    scene.materials[1].emission = {3, 0.5f, 1e8f};
    for (int k = 0; k < 12; ++k) {
        std::vector<Vertex> vertices(9);
        std::vector<uint32_t> indices(9);
        for (uint32_t i = 0; i < 9; ++i) {
            vertices[i].position = point(2), vertices[i].normal = glm::normalize(point(1) + glm::vec3(0, 0, 2)),
            indices[i] = i;
            for (int c = 0; c < 3; ++c) vertices[i].colour[size_t(c)] = uint16_t(32768 + 32000 * unit(random));
        }
        scene::Node node;
        node.translation = {5 * unit(random), 3 * unit(random), -7 + 3 * unit(random)};
        node.rotation = glm::normalize(glm::quat(unit(random), unit(random), unit(random), unit(random)));
        node.scale = {k % 3 == 0 ? -1 : 1, 0.6f + 0.4f * unit(random), 1.3f};
        add_mesh(scene, vertices, indices, uint32_t(k) % 2, node);
    }
    scene::Node again = scene.nodes[3];  // the same mesh a second time, mirrored
    again.translation.x += 2, again.scale = {1, -1, 1};
    scene.nodes.push_back(again);
    return scene;
}

TEST(Gbuffer, MatchesRaysAtEverySize) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 33}, {320, 200}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        expect_scene(rig, soup(extent.width), view_of(extent));
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Normals are interpolated; how inverse depths change is a matter of triangles.
TEST(Gbuffer, SlopesAreThoseOfTriangles) {
    PassRig rig;
    if (snaps_coarsely(rig.device())) GTEST_SKIP() << "small triangles have other planes on such a device";
    const Scene scene = soup(11);
    const View view = view_of({320, 200});
    const Layers got = draw(rig, scene, view);
    const reference::Geometry g = geometry_of(scene, scene::world_transforms(scene, 0), view.world_to_view);
    const reference::Rays rays = rays_of(view);
    size_t compared = 0, steep = 0;
    for (size_t i = 0; i < got.slope.size(); ++i) {
        const glm::dvec2 pixel = glm::dvec2(i % view.extent.width, i / view.extent.width) + 0.5;
        if (!reference::certain(g, rays, pixel, 0.1)) continue;
        const reference::Seen here = reference::cast(g, rays, pixel);
        if (here.depth == 0) continue;
        const glm::vec2 slope = glm::unpackHalf2x16(got.slope[i]) / shared::kSlopeScale;
        for (const int axis : {0, 1}) {
            glm::dvec2 step(0);
            step[axis] = 0.01;
            const double want = (here.depth / reference::cast(g, rays, pixel + step).depth - 1) / 0.01;
            EXPECT_NEAR(double(slope[axis]), want, 2e-3 * std::abs(want) + 2e-6) << i << " " << axis;
            steep += std::abs(want) > 1e-3 ? 1 : 0;
        }
        ++compared;
    }
    EXPECT_GT(compared, 5000u);
    EXPECT_GT(steep, 5000u);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, MatchesRaysFromElsewhereAndOffTheAxis) {
    PassRig rig;
    View view = view_of({97, 61});
    view.world_to_view = glm::lookAt(glm::vec3(6, 4, 2), glm::vec3(0, 0, -7), glm::vec3(0.2f, 1, 0));
    view.tangent_low = {-0.2f, -0.7f}, view.tangent_high = {0.9f, 0.3f};
    const size_t compared = expect_scene(rig, soup(4), view);
    EXPECT_GT(compared, 4000u) << "most pixels are beyond doubt";
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, AFloorReachesTheHorizon) {
    PassRig rig;
    if (snaps_coarsely(rig.device()))
        GTEST_SKIP() << "such a device loses a floor of 1e4 m that reaches behind the eye";
    Scene scene;
    scene.materials = {plain({0.3f, 0.3f, 0.3f})};
    add_mesh(scene, rectangle({-1e5f, -1.2f, 1e5f}, {2e5f, 0, 0}, {0, 0, -2e5f}), kRectangle,
             0);  // also behind the eye
    const View view = view_of({64, 50});
    const Layers got = draw(rig, scene, view);
    reference::Geometry floor;
    floor.planes = {{{0, -1.2, 0}, {0, 1, 0}, 0}}, floor.surfaces.resize(1),
    floor.surfaces[0].base = {0.3, 0.3, 0.3, 1};
    // Depth is interpolated as 1 / z over a triangle 2e5 m long that the near plane cuts.
    expect_reference(got, floor, view, {.depth = 2e-4, .snap = snapped(rig.device())});
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, ASphereIsRound) {
    PassRig rig;
    Scene scene;
    scene.materials = {plain({0.5f, 0.5f, 0.5f})};
    const uint32_t columns = 96, rows = 48;
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i <= columns; ++i) {
            const double polar = 3.14159265358979 * j / rows, around = 2 * 3.14159265358979 * i / columns;
            Vertex v;
            v.normal = {std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around)};
            v.position = 2.0f * v.normal;
            vertices.push_back(v);
            if (i == columns || j == rows) continue;
            const uint32_t a = j * (columns + 1) + i, b = a + columns + 1;
            for (uint32_t k : {a, a + 1, b, a + 1, b + 1, b}) indices.push_back(k);
        }
    scene::Node node;
    node.translation = {1, 0.5f, -8};
    add_mesh(scene, vertices, indices, 0, node);
    const View view = view_of({90, 70});
    const Layers got = draw(rig, scene, view);
    reference::Geometry g;
    g.spheres = {{{1, 0.5, -8}, 2, 0}}, g.surfaces = {{}};
    size_t inside = 0;
    for (uint32_t i = 0; i < 90 * 70; ++i) {
        const auto want = reference::cast(g, rays_of(view), {i % 90 + 0.5, i / 90 + 0.5});
        const glm::dvec3 ray = glm::normalize(rays_of(view).at({i % 90 + 0.5, i / 90 + 0.5}));
        const double facing = want.depth > 0 ? -glm::dot(ray, want.normal) : 0;
        if (facing < 0.3) continue;  // facets cut the silhouette
        ++inside;
        // Facets lie up to r (1 - cos(pi / 96)) and as much again across: 2 mm below the sphere, seen at an angle. A
        // pixel is 0.11 m wide there.
        const double off = std::max(0.003, 0.16 * snapped(rig.device()));
        EXPECT_NEAR(got.surface[i].z, want.depth, off / facing);
        EXPECT_LT(glm::length(reference::octahedral_decode(glm::dvec2(got.surface[i])) - want.normal), off / facing);
    }
    EXPECT_GT(inside, 500u);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, NothingNearerThanTheNearPlaneIsDrawn) {
    PassRig rig;
    Scene scene;
    scene.materials = {plain({1, 0, 0}), plain({0, 1, 0})};
    add_mesh(scene, rectangle({-1, -1, -0.4f}, {2, 0, 0}, {0, 2, 0}), kRectangle, 0);
    add_mesh(scene, rectangle({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}), kRectangle, 1);
    View view = view_of({16, 12});
    view.near = 0.5f;
    expect_scene(rig, scene, view);
    view.near = 0.3f;
    expect_scene(rig, scene, view);
    EXPECT_EQ(rig.complaints(), "");
}

Image noise(uint32_t width, uint32_t height, uint32_t seed, int low = 0) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> code(low, 255);
    Image image{"noise", width, height, {}};
    for (uint32_t i = 0; i < width * height * 4; ++i)
        image.rgba.push_back(i % 4 == 3 ? uint8_t(255) : uint8_t(code(random)));
    return image;
}

/// A wall that fills a 64 x 64 view at z = -2.
Scene wall(const Material& material, std::vector<Image> images) {
    Scene scene;
    scene.images = std::move(images), scene.materials = {material};
    const float r = 2 * std::tan(0.45f);
    add_mesh(scene, rectangle({-r, -r, -2}, {2 * r, 0, 0}, {0, 2 * r, 0}), kRectangle, 0);
    return scene;
}

TEST(Gbuffer, TexturesAreFilteredAsLinearValues) {
    PassRig rig;
    for (const scene::Transfer& transfer : {scene::Transfer{}, scene::Transfer{scene::Transfer::Kind::Gamma, 2.2f}}) {
        Material m = plain({1, 1, 1});
        m.base_colour_texture.image = 0, m.metallic_roughness_texture.image = 1, m.emission_texture.image = 2;
        m.metallic = 0.9f, m.emission = {100, 200, 300};
        Scene scene = wall(m, {noise(8, 8, 1), noise(5, 3, 2), noise(4, 4, 3, 60)});
        scene.transfer = transfer;
        // Devices weigh bilinear taps in steps of 1/256, of values up to 1 and differences as large.
        expect_scene(rig, scene, view_of({64, 64}), {.reflectance = 0.01, .emission = 0.15});
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, DistantTexturesAreMeansOfTheAreaTheyCover) {
    PassRig rig;
    Material m = plain({1, 1, 1});
    m.base_colour_texture.image = 0;
    // 4 x 4 texels to the pixel, so that the second mip level is exactly the area mean.
    const Scene scene = wall(m, {noise(256, 256, 7)});
    expect_scene(rig, scene, view_of({64, 64}), {.reflectance = 0.01, .filter = reference::Filter::Area});
    EXPECT_EQ(rig.complaints(), "");
}

/// Directions around +Z, in the codes of a normal texture.
Image bumps(uint32_t width, uint32_t height, uint32_t seed) {
    Image image = noise(width, height, seed, 90);
    for (size_t i = 0; i < image.rgba.size(); i += 4)
        image.rgba[i] = uint8_t(255 - image.rgba[i]), image.rgba[i + 2] = 220;
    return image;
}

// Turned, mirrored, sheared and from behind: x of the texture leads along u, y against v.
TEST(Gbuffer, ReliefTurnsNormals) {
    PassRig rig;
    Material m = plain({0.5f, 0.5f, 0.5f}, true);
    m.normal_texture.image = 0, m.roughness = 0.5f;
    for (const float scale : {1.0f, 0.3f}) {
        m.normal_scale = scale;
        Scene scene;
        scene.images = {bumps(8, 4, 5)}, scene.materials = {m};
        const glm::vec3 turns[]{{0, 0, 0}, {0.5f, 0.3f, 2}, {0.2f, 3, 0.1f}, {-0.6f, 0.4f, -1}};
        for (int i = 0; i < 4; ++i) {
            scene::Node node;
            node.translation = {float(i % 2) * 2 - 1, float(i / 2) * 1.6f - 0.8f, -4};
            node.rotation = glm::quat(turns[i]);
            node.scale = {i == 3 ? -1 : 1, 1.3f, 1};
            std::vector<Vertex> vertices = rectangle({-0.8f, -0.5f, 0}, {1.6f, 0, 0}, {0, 1, 0});
            for (Vertex& v : vertices) v.uv.x += 0.3f * v.uv.y;
            add_mesh(scene, vertices, kRectangle, 0, node);
        }
        // Devices weigh bilinear taps in steps of 1/256.
        expect_scene(rig, scene, view_of({160, 120}), {.normal = 0.008});
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A corrugation that no pixel resolves: its mean normal is shorter, and its slopes spread the lobe of smooth ones.
TEST(Gbuffer, DistantReliefSpreads) {
    PassRig rig;
    Image ridges{"ridges", 256, 256, {}};
    for (uint32_t i = 0; i < 256 * 256; ++i)
        ridges.rgba.insert(ridges.rgba.end(), {uint8_t(i % 2 ? 64 : 191), 128, 238, 255});
    const double slope = 63.0 / 110, length = 1 / std::sqrt(1 + slope * slope);
    for (const float roughness : {1.0f, 0.4f}) {
        Material m = plain({0.6f, 0.6f, 0.6f});
        m.normal_texture.image = 0, m.roughness = roughness;
        const Layers got = draw(rig, wall(m, {ridges}), view_of({64, 64}));
        const double alpha2 = std::pow(0.4, 4) + 2 * (1 - length) / length;
        for (size_t i = 0; i < got.surface.size(); ++i) {
            EXPECT_LT(
                glm::length(reference::octahedral_decode({got.surface[i].x, got.surface[i].y}) - glm::dvec3(0, 0, 1)),
                1e-3);
            EXPECT_NEAR(got.reflectance[i].x, 0.6 * length, 1e-3);
            EXPECT_NEAR(got.surface[i].w, roughness == 1 ? 1 : std::pow(alpha2, 0.25), 2e-3);
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, TexturesWrapRepeatAndMirror) {
    PassRig rig;
    for (Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
        Material m = plain({1, 1, 1});
        m.base_colour_texture = {0, wrap, wrap, false};
        Scene scene = wall(m, {noise(6, 4, 9)});
        for (Vertex& v : scene.meshes[0].primitives[0].vertices) v.uv = 2.5f * v.uv - 0.7f;
        expect_scene(rig, scene, view_of({64, 64}), {.reflectance = 0.012});
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Of texels larger than a pixel: the part of it that each covers.
TEST(Gbuffer, BordersOfTexelsAreNoStairs) {
    PassRig rig;
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
        Material m = plain({1, 1, 1});
        m.base_colour_texture = {0, wrap, wrap, true}, m.metallic_roughness_texture = {1, wrap, wrap, true};
        m.metallic = 1;
        const Scene scene = wall(m, {noise(9, 7, 5), noise(3, 11, 6)});
        // The reference looks at 16 x 16 points of a pixel: within 1/32 of a border across.
        expect_scene(rig, scene, view_of({64, 64}), {.reflectance = 0.07, .filter = reference::Filter::Area});
    }
    // One colour for all of a surface stays the texel's.
    Material m = plain({1, 1, 1});
    m.base_colour_texture = {0, Wrap::Repeat, Wrap::Repeat, true};
    Scene palette = wall(m, {Image{"", 2, 1, {255, 255, 255, 255, 0, 0, 0, 255}}});
    for (const float u : {0.0f, 0.25f, 0.49f, 0.5f, 0.75f}) {
        for (Vertex& v : palette.meshes[0].primitives[0].vertices) v.uv = {u, 0.5f};
        for (const glm::vec4& seen : draw(rig, palette, view_of({8, 8})).reflectance)
            EXPECT_EQ(seen.r, u < 0.5f ? 1.0f : 0.0f) << u;
    }
    EXPECT_EQ(rig.complaints(), "");
}

/// Values of these decades around 1, evenly in their logarithms.
photometry::LuminancePicture lamps(uint32_t side, uint32_t seed, float decades) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> exponent(-decades / 2, decades / 2);
    photometry::LuminancePicture picture{.name = "lights", .width = side, .height = side, .rgb = {}};
    for (uint32_t i = 0; i < side * side * 3; ++i) picture.rgb.push_back(std::pow(10.0f, exponent(random)));
    return picture;
}

Scene shining_wall(photometry::LuminancePicture picture, float scale,
                   scene::TextureUse use = {0, Wrap::Repeat, Wrap::Repeat, false}) {
    Material m = plain({0.3f, 0.3f, 0.3f});
    m.emission_picture = use, m.emission = glm::vec3(scale);
    Scene scene = wall(m, {});
    scene.luminance_pictures = {std::move(picture)};
    return scene;
}

// From 1e-4 cd/m^2 to a headlamp's 1e8 in one picture, where half floats end at 65504.
TEST(Gbuffer, PicturesOfLightShowTheirLuminance) {
    PassRig rig;
    const scene::TextureUse nearest{0, Wrap::Clamp, Wrap::Clamp, true};
    const Scene scene = shining_wall(lamps(8, 11, 12), 100, nearest);
    EXPECT_GT(*std::max_element(scene.luminance_pictures[0].rgb.begin(), scene.luminance_pictures[0].rgb.end()), 3e5f);
    expect_scene(rig, scene, view_of({64, 64}), {.emission = 1e-6, .filter = reference::Filter::Nearest});
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, PicturesOfLightAreFilteredAsLuminance) {
    PassRig rig;
    // 32 to 316 cd/m^2. Devices weigh taps in steps of 1/256: 2 * 284 / 256 = 2.2 cd/m^2.
    expect_scene(rig, shining_wall(lamps(8, 12, 1), 100), view_of({64, 64}), {.emission = 0.02, .emission_floor = 120});
    // 4 x 4 texels to the pixel: the second mip level is the mean over exactly those.
    expect_scene(rig, shining_wall(lamps(256, 13, 6), 100), view_of({64, 64}),
                 {.emission = 1e-3, .filter = reference::Filter::Area});
    EXPECT_EQ(rig.complaints(), "");
}

// Where 32-bit floats cannot be filtered: 2^-11 of the value, from 1e-9 of the brightest on.
TEST(Gbuffer, PicturesOfLightInHalfFloats) {
    PassRig rig;
    const scene::TextureUse nearest{0, Wrap::Clamp, Wrap::Clamp, true};
    expect_scene(rig, shining_wall(lamps(8, 14, 8.9f), 2e4f, nearest), view_of({64, 64}),
                 {.emission = 5e-4, .filter = reference::Filter::Nearest, .pictures = gpu_scene::PictureFormat::Half});
    photometry::LuminancePicture black = lamps(2, 15, 1);
    std::fill(black.rgb.begin(), black.rgb.end(), 0.0f);
    expect_scene(rig, shining_wall(black, 7), view_of({64, 64}), {.pictures = gpu_scene::PictureFormat::Half});
    EXPECT_EQ(rig.complaints(), "");
}

// COLOR_0 of 0.001 and 0.003, which 8 bits would make 0 and 0.004.
TEST(Gbuffer, DarkVertexColoursStayWhatTheyAre) {
    PassRig rig;
    Scene scene = wall(plain({1, 1, 1}), {});
    for (Vertex& v : scene.meshes[0].primitives[0].vertices) v.colour = {66, 197, 1000, 65535};
    for (const glm::vec4& seen : draw(rig, scene, view_of({8, 8})).reflectance)
        for (const auto& [c, want] : {std::pair(0, 66.0), {1, 197.0}, {2, 1000.0}})
            EXPECT_NEAR(seen[c] * 65535 / want, 1, 0.002);
    EXPECT_EQ(rig.complaints(), "");
}

// The table says how much a road reflects: colours of its vertices, and where in an atlas it lies, only how that
// varies.
TEST(Gbuffer, RoadsReflectWhatTheirTableSaysWhateverTheirColourIs) {
    PassRig rig;
    Material road = plain({0.5f, 0.5f, 0.5f});
    road.reflection_table = 0;
    const auto mean = [&](Scene scene) {
        scene.reflection_tables = {photometry::find_reflection_table("R3")};
        double sum = 0;
        for (const glm::vec4& seen : draw(rig, scene, view_of({16, 16})).reflectance) sum += seen.g / 256;
        return sum;
    };
    const double plain_road = mean(wall(road, {}));
    EXPECT_GT(plain_road, 0.1);
    Scene coloured = wall(road, {});
    for (Vertex& v : coloured.meshes[0].primitives[0].vertices) v.colour = {16384, 16384, 16384, 65535};
    EXPECT_NEAR(mean(coloured) / plain_road, 1, 1e-3);
    Scene varied = coloured;  // its left half darker than the right one
    for (Vertex& v : varied.meshes[0].primitives[0].vertices)
        if (v.uv.x < 0.5f) v.colour = {6554, 6554, 6554, 65535};
    EXPECT_NEAR(mean(varied) / plain_road, 1, 2e-3);
    road.base_colour_texture = {0, Wrap::Repeat, Wrap::Repeat, true};
    const Image atlas{"atlas", 4, 1, {255, 255, 255, 255, 255, 255, 255, 255, 40, 40, 40, 255, 10, 10, 10, 255}};
    for (const auto& [low, high] : {std::pair(0.1f, 0.1f), {0.6f, 0.7f}, {0.9f, 0.9f}, {0.5f, 1.0f}, {0.0f, 1.0f}}) {
        Scene tile = wall(road, {atlas});
        for (Vertex& v : tile.meshes[0].primitives[0].vertices) v.uv = {v.uv.x < 0.5f ? low : high, 0.5f};
        EXPECT_NEAR(mean(tile) / plain_road, 1, 2e-3) << low << " to " << high;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// 3.9.4: what is not less than the cutoff is opaque, also where a half float is less than the code it came from.
TEST(Gbuffer, OpacityThatEqualsTheCutoffIsOpaque) {
    PassRig rig;
    for (const int code : {1, 26, 51, 77, 128, 204, 254, 255})
        for (const int alpha : {code - 1, code}) {
            Material m = plain({1, 1, 1});
            m.alpha = Material::Alpha::Mask, m.alpha_cutoff = float(code / 255.0), m.base_colour_texture.image = 0;
            const Layers got = draw(rig, wall(m, {Image{"", 1, 1, {255, 255, 255, uint8_t(alpha)}}}), view_of({2, 2}));
            EXPECT_EQ(got.surface[0].z > 0, alpha == code) << alpha << " of " << code;
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, MaskedFoliageHasHoles) {
    PassRig rig;
    Material leaf = plain({0.2f, 0.7f, 0.1f}, true);
    leaf.alpha = Material::Alpha::Mask;
    leaf.base_colour_texture = {0, Wrap::Clamp, Wrap::Clamp, true};
    Image holes{"holes", 9, 7, std::vector<uint8_t>(9 * 7 * 4, 180)};
    for (size_t i = 0; i < holes.rgba.size(); i += 4) holes.rgba[i + 3] = (i / 4 * 7) % 3 == 0 ? 0 : 255;
    for (const float cutoff : {0.1f, 0.5f, 0.9f}) {  // borders of its texels are where they are
        leaf.alpha_cutoff = cutoff;
        Scene scene = wall(leaf, {holes});
        scene.materials.push_back(plain({0.9f, 0.9f, 0.9f}));
        add_mesh(scene, rectangle({-9, -9, -6}, {18, 0, 0}, {0, 18, 0}), kRectangle, 1);
        const size_t compared = expect_scene(rig, scene, view_of({64, 64}), {.filter = reference::Filter::Nearest});
        EXPECT_GT(compared, 3000u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Gbuffer, AnEmptySceneIsSky) {
    PassRig rig;
    const Layers got = draw(rig, Scene{}, view_of({7, 5}));
    for (const glm::vec4& s : got.surface) EXPECT_EQ(s.z, 0);
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::gbuffer_test
