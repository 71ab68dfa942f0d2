// Frames that are submitted without waiting: the same as those that are waited for, whenever their results are asked
// for. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "graph/executor.h"
#include "render/renderer.h"
#include "support/rooms.h"

namespace vesper::test::frames_in_flight_test {
namespace {

constexpr VkExtent2D kExtent{61, 37};

gpu_scene::View looking(unsigned frame) {
    gpu_scene::View view = gpu_scene::View::symmetric(kExtent, 0.6f, glm::dmat4(1));
    view.world_to_view[3] = glm::dvec4(0.1 * frame, 0, 0, 1);
    return view;
}

/// A card before a wall, both of their own light, and an eye that goes by and adapts.
class FramesInFlight : public testing::Test {
protected:
    FramesInFlight() {
        add_rectangle(scene, add_material(scene, 0, 2), {-60, -60, -41}, {120, 0, 0}, {0, 120, 0});
        add_rectangle(scene, add_material(scene, 0, 300), {-1, -1.5f, -40}, {2, 0, 0}, {0, 3, 0});
        frame.world = scene::world_transforms(scene, 0);
        settings.indirect = false;
        settings.glare = render::Glare::Scatter;
    }
    void TearDown() override { EXPECT_EQ(complaints_, ""); }

    void submit(render::Renderer& renderer, unsigned index) {
        renderer.submit(settings, looking(index), frame, index == 0 ? 0 : 0.1f, {}, {});
    }
    /// Frames one after the other.
    std::vector<render::Frame> in_lockstep(unsigned count) {
        render::Renderer renderer(device, scene);
        std::vector<render::Frame> frames;
        for (unsigned i = 0; i < count; ++i)
            frames.push_back(renderer.render(settings, looking(i), frame, i == 0 ? 0 : 0.1f, {}));
        return frames;
    }
    static void expect_same(const render::Frame& got, const render::Frame& want, unsigned index) {
        EXPECT_EQ(got.display, want.display) << index;
        EXPECT_EQ(std::memcmp(&got.eye, &want.eye, sizeof got.eye), 0) << index;
        EXPECT_FALSE(got.timings.empty());
    }

    scene::Scene scene;
    gpu_scene::SceneFrame frame;
    render::RenderSettings settings;
    std::string complaints_;
    gpu::Device device{
        {.select = "", .validation = true, .on_message = [this](const std::string& m) { complaints_ += m + "\n"; }}};
};

// Results come in the order of the frames, each once.
TEST_F(FramesInFlight, ComeInTheirOrder) {
    const std::vector<render::Frame> want = in_lockstep(8);
    render::Renderer renderer(device, scene);
    unsigned taken = 0;
    for (unsigned i = 0; i < want.size(); ++i) {
        submit(renderer, i);
        if (i < 2) continue;
        const std::optional<render::Frame> got = renderer.finish_oldest(true);
        ASSERT_TRUE(got);
        expect_same(*got, want[taken], taken), ++taken;
    }
    while (const std::optional<render::Frame> got = renderer.finish_oldest(true))
        expect_same(*got, want[taken], taken), ++taken;
    EXPECT_EQ(taken, want.size());
    EXPECT_FALSE(renderer.finish());
}

// Without waiting each comes when it is done, and none is skipped.
TEST_F(FramesInFlight, ComeWhenTheyAreDone) {
    const std::vector<render::Frame> want = in_lockstep(3);
    render::Renderer renderer(device, scene);
    EXPECT_FALSE(renderer.finish_oldest(true)) << "nothing was submitted";
    for (unsigned i = 0; i < want.size(); ++i) submit(renderer, i);
    for (unsigned taken = 0; taken < want.size();)
        if (const std::optional<render::Frame> got = renderer.finish_oldest(false))
            expect_same(*got, want[taken], taken), ++taken;
    EXPECT_FALSE(renderer.finish_oldest(true));
}

// Of those in flight finish() has the last; and results are lost of what too many frames follow.
TEST_F(FramesInFlight, OfTooManyTheLastRemain) {
    const unsigned most = graph::Executor::kFramesUnderWay, count = most + 2;
    const std::vector<render::Frame> want = in_lockstep(count + 1);
    render::Renderer renderer(device, scene);
    for (unsigned i = 0; i < count; ++i) submit(renderer, i);
    const std::optional<render::Frame> oldest = renderer.finish_oldest(true);
    ASSERT_TRUE(oldest);
    expect_same(*oldest, want[count - most], count - most);
    submit(renderer, count);
    const std::optional<render::Frame> last = renderer.finish();
    ASSERT_TRUE(last);
    expect_same(*last, want[count], count);
    EXPECT_FALSE(renderer.finish_oldest(true));
    EXPECT_EQ(std::memcmp(&renderer.eye(), &want[count].eye, sizeof last->eye), 0);
}

// The host waits for nothing but the frames that it asks for.
TEST_F(FramesInFlight, NothingElseIsWaitedFor) {
    render::Renderer renderer(device, scene);
    for (unsigned i = 0; i < 6; ++i) submit(renderer, i);
    renderer.finish();
    const gpu::DeviceUse before = device.use();
    for (unsigned i = 6; i < 6 + graph::Executor::kFramesUnderWay; ++i) submit(renderer, i);
    EXPECT_EQ(device.use().waits, before.waits);
    EXPECT_EQ(device.use().submissions, before.submissions + graph::Executor::kFramesUnderWay);
    while (renderer.finish_oldest(true)) {
    }
    EXPECT_EQ(device.use().waits, before.waits + graph::Executor::kFramesUnderWay);
}

// Screens of several sizes, one after the other: each has what its last frame had. Their glare is of a shared eye,
// which has a fit for each; a renderer has one.
TEST_F(FramesInFlight, SizesInTurnMakeNothing) {
    settings.glare = render::Glare::None;
    render::Renderer renderer(device, scene);
    for (unsigned round = 0; round < 6; ++round) {
        const uint64_t before = device.use().objects;
        for (const VkExtent2D extent : {VkExtent2D{61, 37}, {96, 60}, {33, 80}}) {
            const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.6f, glm::dmat4(1));
            const render::Frame got = renderer.render(settings, view, frame, 0.1f, {});
            EXPECT_EQ(got.extent.width, extent.width);
        }
        if (round >= 3) {
            EXPECT_EQ(device.use().objects, before) << round;
        }
    }
}

}  // namespace
}  // namespace vesper::test::frames_in_flight_test
