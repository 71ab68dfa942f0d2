// The memory of shadow maps as a setting. SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "render/renderer.h"
#include "support/rooms.h"

namespace vesper::test {
namespace {

// A floor under cards, and lamps in rows above: each lamp shines to all sides.
struct Lamps {
    scene::Scene scene;
    gpu_scene::SceneFrame moment;
    render::RenderSettings settings;

    explicit Lamps(int rows) {
        const uint32_t grey = add_material(scene, 0.5f);
        add_rectangle(scene, grey, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20});
        add_rectangle(scene, grey, {-1.03f, 2, 1.07f}, {2, 0, 0.3f}, {-0.3f, 0, -2});
        for (int x = 0; x < rows; ++x)
            for (int z = 0; z < rows; ++z) add_lamp(scene, 100, {0.27 * x - 2, 4, 0.31 * z - 2});
        moment.world = scene::world_transforms(scene, 0);
        settings.indirect = settings.anti_aliasing = false;
    }
    render::Frame render(render::Renderer& renderer, uint32_t memory) {
        settings.shadow_memory = memory;
        const gpu_scene::View above = gpu_scene::View::symmetric(
            {96, 96}, 0.9f, glm::dmat4(glm::lookAt(glm::dvec3(0, 12, 0), glm::dvec3(0), glm::dvec3(0, 0, -1))));
        return renderer.render(settings, above, moment, 0, {.display = false, .scene = true});
    }
};

uint64_t mebibytes(const render::Frame& frame) { return frame.maps.bytes >> 20u; }

// Maps that take more than there is are smaller, from frame to frame, and take all that there is; equal maps again.
TEST(ShadowMemory, LimitsTheSidesOfMaps) {
    Lamps lamps(4);
    gpu::Device device({.select = ""});
    render::Renderer renderer(device, lamps.scene);
    const render::Frame usual = lamps.render(renderer, 192), small = lamps.render(renderer, 64),
                        again = lamps.render(renderer, 192);
    for (const auto& [frame, memory] : {std::pair(&usual, 192u), std::pair(&small, 64u), std::pair(&again, 192u)}) {
        EXPECT_LE(frame->maps.bytes, uint64_t{memory} << 20u);
        EXPECT_GE(mebibytes(*frame), memory - 2);
        EXPECT_EQ(frame->maps.lamps, 16u);
    }
    EXPECT_EQ(again.scene, usual.scene);
    size_t other = 0;
    double sum = 0, off = 0;
    for (size_t i = 0; i < usual.scene.size(); i += 4) {
        other += small.scene[i] != usual.scene[i];
        sum += double(usual.scene[i]), off += double(std::abs(small.scene[i] - usual.scene[i]));
    }
    EXPECT_GT(other, 0u) << "no edge has moved";
    EXPECT_LT(off, 0.05 * sum) << "more than edges has changed";
}

// Few lamps take what their largest maps need.
TEST(ShadowMemory, IsNotTakenWithoutNeed) {
    Lamps lamp(1);
    gpu::Device device({.select = ""});
    render::Renderer renderer(device, lamp.scene);
    EXPECT_LE(mebibytes(lamp.render(renderer, 1024)), 2 * 16 + 16 + 12 + 1u);
}

TEST(ShadowMemory, TooManyLampsAreAnErrorThatNamesIt) {
    Lamps lamps(34);
    gpu::Device device({.select = ""});
    render::Renderer renderer(device, lamps.scene);
    try {
        lamps.render(renderer, 64);
        ADD_FAILURE() << "1156 lamps to all sides fit";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("1156 lamps do not fit --shadow-memory 64 (MiB)"), std::string::npos)
            << error.what();
    }
    lamps.settings.shadows = false;
    EXPECT_EQ(lamps.render(renderer, 64).maps.lamps, 0u);
    lamps.settings.shadows = true;
    const render::Frame more = lamps.render(renderer, 96);
    EXPECT_EQ(more.maps.lamps, 1156u);
    EXPECT_LE(more.maps.bytes, 96ull << 20u);
}

}  // namespace
}  // namespace vesper::test
