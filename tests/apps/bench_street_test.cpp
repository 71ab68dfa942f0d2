// Scenes, views and the machine of the benchmark. SPDX-License-Identifier: MIT
#include <unistd.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "machine.h"
#include "measure.h"
#include "places.h"
#include "render/passes/pyramid.h"
#include "scenes.h"
#include "street.h"
#include "support/pass_rig.h"

namespace vesper::test {
namespace {

using bench::lamp_street;

uint64_t triangles_of(const scene::Scene& scene) {
    uint64_t total = 0;
    for (const scene::Node& node : scene.nodes)
        if (node.mesh != scene::kNone)
            for (const scene::Primitive& p : scene.meshes[node.mesh].primitives) total += p.indices.size() / 3;
    return total;
}

uint32_t lamps_of(const scene::Scene& scene) {
    uint32_t total = 0;
    for (const scene::Node& node : scene.nodes) total += node.lamp != scene::kNone;
    return total;
}

TEST(BenchStreet, HasAsManyLampsAndTrianglesAsAskedFor) {
    for (const uint32_t lamps : {1u, 2u, 65u, 256u, 4096u})
        for (const uint64_t triangles : {0ull, 1000ull, 100000ull, 1000000ull}) {
            const scene::Scene scene = lamp_street(lamps, triangles);
            EXPECT_EQ(lamps_of(scene), lamps);
            EXPECT_GE(triangles_of(scene), triangles);
            // A patch has at most one row of cells more than it needs.
            const double pieces = double(scene.nodes.size() - lamps - 1);
            EXPECT_LE(double(triangles_of(scene)),
                      double(triangles) + 2 * pieces * (1 + std::sqrt(double(triangles) / (2 * pieces) + 1)))
                << lamps << " " << triangles;
        }
}

// Each patch is as large as the street's wall or road, whatever it is cut into, and its front is where its normals
// point.
TEST(BenchStreet, PatchesCoverTheStreetAndFaceIt) {
    const scene::Scene scene = lamp_street(10, 12345);
    ASSERT_EQ(scene.meshes.size(), 3u);
    const double areas[]{14 * 12, 15 * 12, 15 * 12};  // m^2
    const glm::vec3 normals[]{{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}};
    for (size_t i = 0; i < 3; ++i) {
        const scene::Primitive& p = scene.meshes[i].primitives[0];
        double area = 0;
        for (size_t t = 0; t < p.indices.size(); t += 3) {
            const glm::vec3 a = p.vertices[p.indices[t]].position, b = p.vertices[p.indices[t + 1]].position,
                            c = p.vertices[p.indices[t + 2]].position;
            const glm::vec3 twice = glm::cross(b - a, c - a);
            EXPECT_NEAR(glm::dot(twice, normals[i]), glm::length(twice), 1e-5);
            area += 0.5 * double(glm::length(twice));
        }
        EXPECT_NEAR(area / areas[i], 1, 1e-5) << i;
        for (const scene::Vertex& v : p.vertices) EXPECT_NEAR(glm::distance(v.normal, normals[i]), 0, 1e-6);
    }
}

TEST(BenchStreet, LampsStandAlongItAndShineDown) {
    const scene::Scene scene = lamp_street(64, 0);
    const auto world = scene::world_transforms(scene, 0);
    float first = -1, last = 0;
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].lamp == scene::kNone) continue;
        const glm::vec3 at(world[i][3]), axis = glm::vec3(world[i] * glm::vec4(0, 0, -1, 0));
        EXPECT_NEAR(glm::distance(axis, glm::vec3(0, -1, 0)), 0, 1e-6);
        EXPECT_EQ(at.y, 6.5f);
        EXPECT_EQ(std::abs(at.x), 6);
        first = std::max(first, at.z), last = std::min(last, at.z);
    }
    EXPECT_EQ(first, 0);
    EXPECT_EQ(last, -31 * 12);
    // The eye drives 10 s at 50 km/h.
    EXPECT_EQ(scene::animation_length(scene), 10);
    EXPECT_NEAR(scene::world_transforms(scene, 10).back()[3].z, -500 / 3.6, 1e-3);
}

// Whatever they are, they send as much light down as a point of 1,500 cd.
TEST(BenchStreet, LampsCanBeOfAnotherKind) {
    const scene::Scene measured = lamp_street(64, 0, VESPER_SOURCE_DIR "/data/photometry/street-lamp.ies"),
                       points = lamp_street(64, 0, "point"), dark = lamp_street(64, 0, "none");
    ASSERT_EQ(measured.distributions.size(), 1u);
    EXPECT_EQ(measured.lamps.at(0).kind, scene::Lamp::Kind::Measured);
    EXPECT_NEAR(double(measured.lamps[0].intensity) * photometry::luminous_flux(measured.distributions[0]),
                2 * std::numbers::pi * 1500, 0.01);
    EXPECT_EQ(points.lamps.at(0).kind, scene::Lamp::Kind::Point);
    EXPECT_EQ(points.lamps[0].intensity, 1500);
    EXPECT_EQ(lamps_of(measured), 64u);
    EXPECT_EQ(lamps_of(points), 64u);
    EXPECT_EQ(lamps_of(dark), 0u);
    EXPECT_EQ(triangles_of(dark), triangles_of(points));
    EXPECT_THROW(lamp_street(64, 0, "nowhere.ies"), Error);
}

// Lamps stand in the streets of the square kilometre, as many and as evenly as that goes.
TEST(BenchTown, HasItsLampsInTheStreetsOfASquareKilometre) {
    for (const uint32_t lamps : {1u, 256u, 4096u}) {
        const scene::Scene scene = bench::lamp_town(lamps, 20000);
        EXPECT_EQ(lamps_of(scene), lamps);
        EXPECT_GE(triangles_of(scene), 20000u);
        const auto world = scene::world_transforms(scene, 0);
        double left = 0;
        for (size_t i = 0; i < scene.nodes.size(); ++i) {
            if (scene.nodes[i].lamp == scene::kNone) continue;
            const glm::dvec3 at(world[i][3]);
            EXPECT_LE(std::max(std::abs(at.x), std::abs(at.z)), 500);
            EXPECT_EQ(at.y, 6.5);
            // Houses are 86 m wide, and their middles 100 m apart, from -450 m on.
            const auto from_middle = [](double v) { return std::abs(std::fmod(v + 500, 100) - 50); };
            EXPECT_NEAR(std::max(from_middle(at.x), from_middle(at.z)), 44, 1e-3) << at.x << " " << at.z;
            left += at.x < 0 ? 1 : 0;
        }
        if (lamps > 1) {
            EXPECT_NEAR(left / lamps, 0.5, 0.05);
        }
    }
    EXPECT_EQ(lamps_of(bench::lamp_town(64, 0, "none")), 0u);
}

// The eye drives along the street in the middle and never into a house.
TEST(BenchTown, TheEyeStaysInItsStreet) {
    const scene::Scene scene = bench::lamp_town(4, 0);
    for (double seconds = 0; seconds <= 10; seconds += 0.5) {
        const glm::dvec3 at(scene::world_transforms(scene, seconds).back()[3]);
        EXPECT_NEAR(at.x, 1.75, 1e-5);
        EXPECT_NEAR(at.z, 150 - seconds * 50 / 3.6, 1e-3);
    }
}

TEST(BenchScenes, GeneratedOnesHaveLampsOfTheirOwnNumber) {
    const bench::Scenes scenes;
    EXPECT_EQ(lamps_of(scenes.load("street", bench::kOwnLamps, 0, "", "")), 256u);
    EXPECT_EQ(lamps_of(scenes.load("town", bench::kOwnLamps, 0, "", "")), 4096u);
    EXPECT_EQ(lamps_of(scenes.load("town", 5, 0, "", "")), 5u);
}

TEST(BenchScenes, TheNearestLampsStay) {
    scene::Scene scene = lamp_street(64, 0);
    bench::keep_nearest_lamps(scene, {0, 6.5f, -120}, 6);
    const auto world = scene::world_transforms(scene, 0);
    EXPECT_EQ(lamps_of(scene), 6u);
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != scene::kNone) {
            EXPECT_LE(std::abs(world[i][3].z + 120), 12);
        }
    EXPECT_THROW(bench::keep_nearest_lamps(scene, {}, 7), Error);
}

// Where one channel's image ends the next begins: the direction of the right edge of one is that of the left edge of
// the other.
TEST(BenchChannels, StandSideBySide) {
    const gpu_scene::View camera = gpu_scene::View::symmetric({1600, 1000}, 0.6f, glm::mat4(1));
    ASSERT_EQ(bench::channel_views(camera, 1).at(0).world_to_view, camera.world_to_view);
    const std::vector<gpu_scene::View> views = bench::channel_views(camera, 3);
    const auto edge = [](const gpu_scene::View& view, float tangent) {
        return glm::normalize(glm::vec3(glm::inverse(view.world_to_view) * glm::vec4(tangent, 0, -1, 0)));
    };
    EXPECT_NEAR(glm::distance(edge(views[0], camera.tangent_high.x), edge(views[1], camera.tangent_low.x)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(edge(views[1], camera.tangent_high.x), edge(views[2], camera.tangent_low.x)), 0, 1e-6);
    EXPECT_LT(edge(views[0], 0).x, 0) << "the first is on the left";
    EXPECT_NEAR(glm::distance(edge(views[1], 0), glm::vec3(0, 0, -1)), 0, 1e-6);
}

TEST(BenchMachine, CopiesInOrder) {
    PassRig rig;
    EXPECT_GT(bench::device_copy_bandwidth(rig.device(), 1 << 16), 0);
    EXPECT_GT(bench::host_copy_bandwidth(1 << 16), 0);
    EXPECT_GT(bench::arithmetic_ms(1 << 12), 0);
    EXPECT_EQ(rig.complaints(), "") << "validation";
}

TEST(BenchMachine, ThePeakOfMemoryIsForgotten) {
    if (access("/proc/self/clear_refs", W_OK) != 0) GTEST_SKIP() << "this system does not forget";
    bench::forget_peak_host_bytes();
    const uint64_t before = bench::peak_host_bytes();
    {
        const std::vector<char> large(200 << 20, 'x');
        asm volatile("" : : "r"(large.data()) : "memory");  // is used: clang makes none that is not
    }
    EXPECT_GE(bench::peak_host_bytes(), before + (190 << 20));
    bench::forget_peak_host_bytes();
    EXPECT_LT(bench::peak_host_bytes(), before + (100 << 20));
}

// What is given back counts no more, but was there.
TEST(BenchMachine, TheDeviceKeepsAccount) {
    const gpu::Device device;
    const gpu::DeviceUse& use = device.use();
    const uint64_t start = use.bytes;
    {
        const uint32_t type = device.memory_type(~0u, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        gpu::OwnedMemory a = gpu::allocate(device, 3 << 20, type), b = gpu::allocate(device, 1 << 20, type);
        EXPECT_EQ(use.bytes, start + (4 << 20));
        a = {};
        EXPECT_EQ(use.bytes, start + (1 << 20));
        const gpu::OwnedMemory c = std::move(b);
        EXPECT_EQ(use.bytes, start + (1 << 20));
    }
    EXPECT_EQ(use.bytes, start);
    EXPECT_EQ(use.peak_bytes, start + (4 << 20));
    const uint32_t pipelines = use.pipelines;
    gpu::KernelCache kernels(device);
    const gpu::GraphicsPipelineCache none(device);
    for (int time = 0; time < 2; ++time) {
        graph::FrameGraph graph;
        const graph::Resource scene =
            PassRig::image(graph, "scene", render::kSceneFormat, {4, 4}, std::vector<glm::vec4>(16));
        render::add_pyramid({graph, kernels, none, {.extent = {4, 4}}}, scene);
        EXPECT_EQ(use.pipelines, pipelines + (time == 0 ? 0 : 2)) << "none before it is needed";
        kernels.compile();
        EXPECT_EQ(use.pipelines, pipelines + 2) << "one for the first level, one for the others; none the second time";
    }
    EXPECT_GT(use.pipeline_ms, 0);
}

}  // namespace
}  // namespace vesper::test
