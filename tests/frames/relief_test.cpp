// Relief of a normal texture against the same relief as triangles. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "places.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace vesper::test {
namespace {

constexpr int kRidges = 64, kFacetTexels = 4;  // across a panel of 2 m; texels of a facet
constexpr double kSide = 2;                    // m

/// A panel at z = 0 with ridges along Y, whose facets have slopes of +-`slope`: of triangles, or of a texture.
scene::Scene panel(bool textured, double slope, float roughness) {
    scene::Scene scene;
    scene::Material material;
    material.base_colour = {0.4f, 0.4f, 0.4f, 1}, material.roughness = roughness;
    if (textured) {
        material.normal_texture = {.image = 0, .wrap_u = scene::Wrap::Clamp, .wrap_v = scene::Wrap::Clamp};
        // In codes, as painters have it; the steps of codes are a quarter of a degree.
        Image codes{"ridges", 2 * kRidges * kFacetTexels, 1, {}};
        const double length = std::sqrt(1 + slope * slope);
        for (uint32_t i = 0; i < codes.width; ++i) {
            const double x = (i / kFacetTexels % 2 == 0 ? -slope : slope) / length;
            const auto code = [](double value) {
                return uint8_t(std::lround(127.5 + value * 127 + (value < 0 ? -0.5 : 0.5)));
            };
            codes.rgba.insert(codes.rgba.end(), {code(x), 128, code(1 / length), 255});
        }
        scene.images = {codes};
    }
    scene.materials = {material};
    scene::Primitive made;
    const auto add = [&](double left, double right, double from, double to) {
        const glm::vec3 normal = glm::normalize(glm::vec3(-(to - from) / (right - left), 0, 1));
        const auto first = uint32_t(made.vertices.size());
        for (const auto& [x, y, z] : {std::tuple(left, -kSide / 2, from),
                                      {right, -kSide / 2, to},
                                      {right, kSide / 2, to},
                                      {left, kSide / 2, from}}) {
            scene::Vertex v;
            v.position = {x, y, z}, v.normal = normal, v.uv = {x / kSide + 0.5, 0.5 - y / kSide};
            made.vertices.push_back(v), made.bounds.add(v.position);
        }
        for (const uint32_t corner : {0, 1, 2, 0, 2, 3}) made.indices.push_back(first + corner);
    };
    const double facet = kSide / (2 * kRidges);
    for (int i = 0; i < 2 * kRidges && !textured; ++i)
        add(-kSide / 2 + i * facet, -kSide / 2 + (i + 1) * facet, i % 2 * slope * facet, (i + 1) % 2 * slope * facet);
    if (textured) add(-kSide / 2, kSide / 2, 0, 0);
    scene.meshes.push_back({"panel", {made}});
    scene.lamps.push_back({.name = "lamp", .kind = scene::Lamp::Kind::Point, .intensity = 500});
    scene.nodes.resize(2);
    scene.nodes[0].mesh = 0, scene.nodes[1].lamp = 0, scene.nodes[1].translation = {4, 0.5f, 3};
    return scene;
}

/// Mean luminance of the middle of the panel, cd/m^2, seen from 2 m in front of it by so many pixels a side.
double mean_luminance(gpu::Device& device, const scene::Scene& scene, uint32_t side) {
    render::Renderer renderer(device, scene);
    const gpu_scene::View view =
        gpu_scene::View::symmetric({side, side}, 0.8f, glm::translate(glm::mat4(1), glm::vec3(0, 0, -2)));
    const render::Frame frame =
        renderer.render({}, view, {scene::world_transforms(scene, 0)}, 0, {.display = false, .scene = true});
    double sum = 0;
    for (size_t i = 0; i < frame.scene.size(); i += 4) sum += frame.scene[i + 1];
    return sum / (double(side) * side);
}

// From a third of a facet to 16 facets in a pixel, as if the panel went away.
TEST(Relief, HasTheMeanLuminanceOfTriangles) {
    gpu::Device device(gpu::DeviceOptions{});
    for (const double slope : {0.2, 0.4})
        for (const float roughness : {1.0f, 0.6f}) {
            const double wanted = mean_luminance(device, panel(false, slope, roughness), 320);
            for (const uint32_t side : {320, 80, 20, 7})
                // Lobes are spread alike in all directions, and steep ridges spread them in one.
                EXPECT_NEAR(mean_luminance(device, panel(true, slope, roughness), side) / wanted, 1,
                            roughness < 1 && slope > 0.3 ? 0.05 : 0.02)
                    << slope << ", roughness " << roughness << ", " << side << " px";
        }
}

// Bumps that face a lamp behind the panel are not lit through it.
TEST(Relief, LetsNoLightThrough) {
    gpu::Device device(gpu::DeviceOptions{});
    for (const float roughness : {1.0f, 0.5f})
        for (const double radius : {0.0, 0.05}) {
            scene::Scene scene = panel(true, 0.4, roughness);
            scene.lamps[0].opening.length = scene.lamps[0].opening.width = 2 * radius,
            scene.lamps[0].opening.round = true;
            scene.nodes[1].translation = {0.3f, 0.2f, -0.6f};
            scene.materials[0].double_sided = true;
            EXPECT_EQ(mean_luminance(device, scene, 64), 0) << roughness << ", " << radius;
            scene.nodes[1].translation.z = 0.6f;
            EXPECT_GT(mean_luminance(device, scene, 64), 1);
        }
}

}  // namespace
}  // namespace vesper::test
