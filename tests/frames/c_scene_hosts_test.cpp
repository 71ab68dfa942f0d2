// Scenes of the C interface in hosts: into images of theirs, and in several threads. SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "places.h"
#include "support/c_scene.h"
#include "support/host_device.h"

namespace vesper::test {
namespace {

// Frames into images of the host's, all handed over at once, while the scene changes: the last as through arrays.
TEST(CSceneOnAHost, RendersIntoImages) {
    HostDevice host;
    VesperError error;
    const VesperHostDevice lent = host.lent();
    VesperDevice* device = nullptr;
    ASSERT_EQ(vesper_device_borrow(&lent, &device, &error), VESPER_OK) << error.message;
    VesperScene* scene = nullptr;
    uint32_t material = 0, mesh = 0, node = 0;
    ASSERT_EQ(vesper_scene_create(&scene, &error), VESPER_OK);
    const VesperMaterial surface = white();
    ASSERT_EQ(vesper_scene_add_material(scene, &surface, &material, &error), VESPER_OK);
    const VesperMesh shape = square(material);
    ASSERT_EQ(vesper_scene_add_mesh(scene, &shape, &mesh, &error), VESPER_OK);
    ASSERT_EQ(vesper_scene_add_node(scene, "ground", mesh, nullptr, &node, &error), VESPER_OK);
    VesperRenderer *images = nullptr, *arrays = nullptr;
    ASSERT_EQ(vesper_renderer_create(device, scene, &images, &error), VESPER_OK);
    VesperView view = down();
    view.width = 33, view.height = 21, view.vertical_fov = 1.5f;
    const VkExtent2D extent{view.width, view.height};
    ::Image shown = host->make_image(VK_FORMAT_B8G8R8A8_SRGB, extent,
                                     VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const VesperImage to = described(shown, VK_FORMAT_B8G8R8A8_SRGB, extent, VK_IMAGE_LAYOUT_UNDEFINED,
                                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    std::vector<uint8_t> codes(4 * 33 * 21);
    VesperOutputs outputs = VESPER_INIT(VesperOutputs);
    outputs.codes = codes.data();
    for (int frame = 0; frame < 6; ++frame) {
        VesperLamp lamp = candle();
        lamp.position[0] = 0.3f * float(frame) - 1, lamp.colour[0] = 2;
        if (frame % 2) {
            ASSERT_EQ(vesper_scene_add_lamp(scene, &lamp, nullptr, &error), VESPER_OK);
        }
        ASSERT_EQ(vesper_render_image(images, nullptr, &view, 0.1f, &to, nullptr, &error), VESPER_OK) << error.message;
    }
    const std::vector<uint8_t> got = host->read(shown, extent, 1);
    // The report stays, though a call before waits for the frame, and another is refused.
    std::vector<uint8_t> eye(vesper_eye_size());
    ASSERT_EQ(vesper_renderer_eye(images, eye.data(), &error), VESPER_OK);
    EXPECT_EQ(vesper_render(images, nullptr, &view, -1, &outputs, &error), VESPER_BAD_ARGUMENT);
    VesperFrameReport report = VESPER_INIT(VesperFrameReport);
    ASSERT_EQ(vesper_renderer_finish(images, &report, &error), VESPER_OK);
    EXPECT_GT(report.adaptation, 0);
    // The same eye, over the same frames: lamps are there from the frame on in which they were added.
    for (const uint32_t removed : {1u, 2u, 3u}) ASSERT_EQ(vesper_scene_remove(scene, removed, &error), VESPER_OK);
    ASSERT_EQ(vesper_renderer_create(device, scene, &arrays, &error), VESPER_OK);
    for (int frame = 0; frame < 6; ++frame) {
        VesperLamp lamp = candle();
        lamp.position[0] = 0.3f * float(frame) - 1, lamp.colour[0] = 2;
        if (frame % 2) {
            ASSERT_EQ(vesper_scene_add_lamp(scene, &lamp, nullptr, &error), VESPER_OK);
        }
        ASSERT_EQ(vesper_render(arrays, nullptr, &view, 0.1f, &outputs, &error), VESPER_OK) << error.message;
    }
    for (size_t i = 0; i < codes.size(); i += 4) std::swap(codes[i], codes[i + 2]);
    EXPECT_EQ(got, codes);
    view.width = 34;
    EXPECT_EQ(vesper_render_image(images, nullptr, &view, 0, &to, nullptr, &error), VESPER_BAD_ARGUMENT)
        << "another extent";
    vesper_renderer_destroy(images), vesper_renderer_destroy(arrays);
    vesper_scene_destroy(scene);
    vesper_device_close(device);
    host->destroy(shown);
}

// Several engines in one process, each in a thread of its own: each gives what it gives alone.
TEST(CSceneInThreads, EnginesDoNotKnowOfOneAnother) {
    const auto frames = [](float intensity) {
        VesperError error;
        VesperDevice* device = nullptr;
        VesperScene* scene = nullptr;
        VesperRenderer* renderer = nullptr;
        uint32_t material = 0, mesh = 0, node = 0;
        const VesperMaterial surface = white();
        VesperLamp lamp = candle();
        lamp.intensity = intensity;
        std::vector<uint8_t> codes(4 * kSide * kSide), all;
        VesperOutputs outputs = VESPER_INIT(VesperOutputs);
        outputs.codes = codes.data();
        const VesperView view = down();
        EXPECT_EQ(vesper_device_open(nullptr, &device, &error), VESPER_OK) << error.message;
        EXPECT_EQ(vesper_scene_create(&scene, &error), VESPER_OK);
        EXPECT_EQ(vesper_scene_add_material(scene, &surface, &material, &error), VESPER_OK);
        const VesperMesh shape = square(material);
        EXPECT_EQ(vesper_scene_add_mesh(scene, &shape, &mesh, &error), VESPER_OK);
        EXPECT_EQ(vesper_scene_add_node(scene, "", mesh, nullptr, &node, &error), VESPER_OK);
        EXPECT_EQ(vesper_scene_add_lamp(scene, &lamp, nullptr, &error), VESPER_OK);
        EXPECT_EQ(vesper_renderer_create(device, scene, &renderer, &error), VESPER_OK);
        for (int frame = 0; frame < 4; ++frame) {
            EXPECT_EQ(vesper_render(renderer, nullptr, &view, 0.1f, &outputs, &error), VESPER_OK) << error.message;
            all.insert(all.end(), codes.begin(), codes.end());
        }
        vesper_renderer_destroy(renderer), vesper_scene_destroy(scene), vesper_device_close(device);
        return all;
    };
    const float intensities[] = {0.1f, 30, 1000};
    std::vector<std::vector<uint8_t>> together(3);
    std::vector<std::thread> threads;
    for (size_t i = 0; i < 3; ++i) threads.emplace_back([&, i] { together[i] = frames(intensities[i]); });
    for (std::thread& thread : threads) thread.join();
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(together[i], frames(intensities[i]));
}

}  // namespace
}  // namespace vesper::test
