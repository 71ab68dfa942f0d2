// The low beam of data/photometry on a wall at 25 m, as a headlamp is measured: UN Regulation No. 112, class B.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "places.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace vesper::test {
namespace {

constexpr double kDistance = 25, kReflectance = 0.5;

/// A wall of 40 m by 20 m, 25 m ahead of a lamp at the origin. The eye is where the lamp is.
scene::Scene headlamp_and_wall() {
    scene::Scene scene;
    scene::Material wall;
    wall.base_colour = glm::vec4(float(kReflectance), float(kReflectance), float(kReflectance), 1);
    scene.materials.push_back(wall);
    scene::Primitive plane;
    for (const glm::vec2 corner : {glm::vec2(-20, -10), {20, -10}, {20, 10}, {-20, 10}}) {
        scene::Vertex vertex;
        vertex.position = {corner.x, corner.y, -kDistance}, vertex.normal = {0, 0, 1};
        plane.vertices.push_back(vertex);
        plane.bounds.add(vertex.position);
    }
    plane.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back({"wall", {plane}});
    scene.distributions.push_back(
        photometry::read_distribution(std::filesystem::path(VESPER_SOURCE_DIR) / "data/photometry/low-beam.csv"));
    scene.lamps.push_back({.name = "low beam", .kind = scene::Lamp::Kind::Measured, .intensity = 1, .distribution = 0});
    scene.nodes.resize(2);
    scene.nodes[0].mesh = 0, scene.nodes[1].lamp = 0;
    return scene;
}

struct Point {
    const char* name;
    double h, v, low, high;  // deg right and up; cd
};
// UN R112, 6.2.4, class B, right-hand traffic.
constexpr Point kPoints[] = {
    {"B50L", -3.43, 0.57, 0, 350},   {"BR", 2.5, 1, 0, 1750},         {"75R", 1.15, -0.57, 10100, 1e9},
    {"75L", -3.43, -0.57, 0, 10600}, {"50L", -3.43, -0.86, 0, 13200}, {"50R", 1.72, -0.86, 10100, 1e9},
    {"50V", 0, -0.86, 5100, 1e9},    {"25L", -9, -1.72, 1700, 1e9},   {"25R", 9, -1.72, 1700, 1e9},
    {"P7", -8, 0, 65, 1e9},          {"P8", -4, 0, 125, 1e9}};

TEST(HeadlampOnAWall, MeetsTheRegulationInTheRenderedImage) {
    gpu::Device device(gpu::DeviceOptions{});
    const scene::Scene scene = headlamp_and_wall();
    render::Renderer renderer(device, scene);
    const VkExtent2D extent{1200, 600};
    const gpu_scene::SceneFrame moment{scene::world_transforms(scene, 0)};
    const gpu_scene::View view =
        gpu_scene::View::symmetric(extent, float(2 * std::atan(0.1)), glm::mat4(1));  // 10 % up and down, 20 % aside
    const render::Frame frame = renderer.render({}, view, moment, 0, {.display = false, .scene = true});
    // Type A angles, deg: a vertical polar axis.
    const auto candela_at = [&](double h, double v) {
        // Where their direction meets the wall, relative to its distance:
        const double x = std::tan(glm::radians(h)), y = std::tan(glm::radians(v)) / std::cos(glm::radians(h));
        const double column = (x / 0.2 + 1) / 2 * extent.width - 0.5, row = (1 - y / 0.1) / 2 * extent.height - 0.5;
        const auto luminance = [&](double c, double r) {
            return double(frame.scene[(size_t(std::floor(r)) * extent.width + size_t(std::floor(c))) * 4 + 1]);
        };
        const double s = column - std::floor(column), t = row - std::floor(row);
        const double seen = (1 - t) * ((1 - s) * luminance(column, row) + s * luminance(column + 1, row)) +
                            t * ((1 - s) * luminance(column, row + 1) + s * luminance(column + 1, row + 1));
        // L = rho E / pi; E = I cos / d^2, with d = 25 m / cos.
        const double illuminance = seen * std::numbers::pi / kReflectance, cosine = 1 / std::sqrt(1 + x * x + y * y);
        const double candela = illuminance * kDistance * kDistance / (cosine * cosine * cosine);
        // And it is the file's own intensity; pixels of 0.02 degrees blur the cut-off a little.
        const double stated = photometry::intensity(scene.distributions[0], {x, y, -1});
        EXPECT_NEAR(candela, stated, 0.01 * stated) << h << ", " << v;
        return candela;
    };
    for (const Point& p : kPoints) {
        const double candela = candela_at(p.h, p.v);
        EXPECT_GE(candela, p.low) << p.name;
        EXPECT_LE(candela, p.high) << p.name;
    }
    EXPECT_GE(candela_at(-8, 4) + candela_at(0, 4) + candela_at(8, 4), 190) << "P1 + P2 + P3";
    EXPECT_GE(candela_at(-4, 2) + candela_at(0, 2) + candela_at(4, 2), 375) << "P4 + P5 + P6";
    for (double h = -5.15; h <= 5.15; h += 0.515)
        for (double v = -1.72; v < -0.85; v += 0.215) EXPECT_GE(candela_at(h, v), 2500) << "zone IV";
    const double most = 2 * candela_at(1.72, -0.86);
    for (double h = -9; h <= 9; h += 1)
        for (double v = -4; v < -1.7; v += 0.57) EXPECT_LE(candela_at(h, v), most) << "zone I";
}

}  // namespace
}  // namespace vesper::test
