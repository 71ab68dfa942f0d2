// What a frame asks of the device: one submission, one wait, and nothing that is made. SPDX-License-Identifier: MIT
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "places.h"
#include "session/session.h"
#include "transport/radiosity.h"

namespace vesper::test {
namespace {

// A drive with traffic, shadows, glare and light between surfaces. The first frames make what all others use.
TEST(SteadyFrames, AreOneSubmissionAndMakeNothing) {
    constexpr int kFrames = 60, kFirst = 4;
    gpu::Device device({.validation = true});
    drive::Session session(device, {.scene = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.world.json"});
    session.set("glare", "cie");
    const gpu_scene::SceneFrame rest = session.moment();
    const transport::RadiositySettings coarse{.cell_size = 4, .rays = 4, .looks = 2, .lamp_rays = 2, .fine_cells = 0};
    auto radiosity = transport::gather_radiosity(session.scenery().scene(), rest.world, rest.moving, coarse);
    ASSERT_TRUE(radiosity);
    session.set_radiosity(std::make_shared<const transport::Radiosity>(std::move(*radiosity)));
    uint32_t maps = 0, bodies = 0;
    for (int i = 0; i < kFrames; ++i) {
        const gpu::DeviceUse before = device.use();
        for (int steps = 0; steps < 4; ++steps) session.step({.throttle = 0.7});
        const render::Frame frame = session.render(VkExtent2D{160, 100}, {.display = true});
        const gpu::DeviceUse& after = device.use();
        maps += frame.maps.maps, bodies += frame.maps.bodies;
        ASSERT_FALSE(frame.timings.empty());
        if (i < kFirst) continue;
        EXPECT_EQ(after.submissions - before.submissions, 1u) << i;
        EXPECT_EQ(after.waits - before.waits, 1u) << i << ": of the frame itself";
        EXPECT_EQ(after.objects - before.objects, 0u) << i;
        EXPECT_EQ(after.pipelines - before.pipelines, 0u) << i;
    }
    for (int i = 0; i < kFrames; ++i) {  // the same in flight
        for (int steps = 0; steps < 4; ++steps) session.step({.throttle = 0.7});
        const gpu_scene::View view = session.view({160, 100});
        const gpu::DeviceUse before = device.use();
        session.submit(view, {.display = true});
        const gpu::DeviceUse& after = device.use();
        EXPECT_EQ(after.submissions - before.submissions, 1u) << i;
        EXPECT_EQ(after.waits - before.waits, 0u) << i << ": beside the oldest frame, which is waited for below";
        if (i >= kFirst) {
            EXPECT_EQ(after.objects - before.objects, 0u) << i;
        }
        while (session.renderer().unfinished() > 1) ASSERT_TRUE(session.finish_oldest(true));
    }
    EXPECT_GT(maps, uint32_t{kFrames});  // headlamps move
    EXPECT_GT(bodies, uint32_t{kFrames});
}

}  // namespace
}  // namespace vesper::test
