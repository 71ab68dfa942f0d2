// Every call of Vulkan fails once: one line is said, nothing is left behind, and where Vulkan allows it the next frame
// is as ever. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "faults/faults.h"
#include "render/renderer.h"
#include "support/scene_geometry.h"

namespace vesper::test {
namespace {

constexpr VkResult kFaults[]{VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST, VK_ERROR_OUT_OF_HOST_MEMORY};

constexpr uint64_t kTries = 15;  // of hundreds of calls, five with each result

/// Faults tried: each of `faults` at every call where VESPER_EVERY_FAULT is set; else one of them in turn, at so many
/// calls from the first to the last. Returns how many that were.
template <class Try>
size_t every_fault(uint64_t calls, std::span<const VkResult> faults, const Try& attempt) {
    size_t tried = 0;
    const auto at = [&](uint64_t n, VkResult code) {
        ++tried;
        SCOPED_TRACE("call " + std::to_string(n) + " of " + std::to_string(calls) + ", result " + std::to_string(code));
        attempt(n, code);
    };
    if (std::getenv("VESPER_EVERY_FAULT")) {
        for (uint64_t n = 1; n <= calls; ++n)
            for (const VkResult code : faults) at(n, code);
    } else {
        const uint64_t tries = std::min(calls, kTries);
        for (uint64_t i = 0; i < tries; ++i) at(1 + i * (calls - 1) / (tries - 1), faults[i % faults.size()]);
    }
    return tried;
}

std::vector<uint8_t> render(render::Renderer& renderer, const scene::Scene& scene, VkExtent2D extent = {16, 8},
                            float seconds = 0) {
    render::RenderSettings settings;
    settings.glare = render::Glare::Scatter;
    if (seconds == 0) renderer.reset_adaptation();
    return renderer
        .render(settings, gpu_scene::View::symmetric(extent, 0.4f, glm::mat4(1)), {scene::world_transforms(scene, 0)},
                seconds, {.display = true})
        .display;
}

/// Disarmed whatever happens.
struct Armed {
    Armed(uint64_t at, VkResult code) { vesper_fault_arm(FaultKind::Vulkan, at, code); }
    ~Armed() { vesper_fault_arm(FaultKind::None, 0, 0); }
};

void expect_line(const Error& error) {
    const std::string said = error.what();
    EXPECT_FALSE(said.empty());
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << said;
}

TEST(VulkanFaults, EveryCallThatFailsEndsInALine) {
    const scene::Scene scene = wall_with_a_lamp();
    std::string complaints;
    std::vector<uint8_t> good;
    const auto from_start = [&] {
        gpu::Device device(
            {.select = "", .validation = true, .on_message = [&](const std::string& m) { complaints += m + "\n"; }});
        render::Renderer renderer(device, scene);
        return render(renderer, scene);
    };
    uint64_t calls = 0;
    {
        const Armed none(0, VK_SUCCESS);
        good = from_start();
        calls = vesper_fault_count();
    }
    ASSERT_GT(calls, 100u);
    size_t failures = 0;
    const size_t tried = every_fault(calls, kFaults, [&](uint64_t n, VkResult code) {
        const Armed armed(n, code);
        try {
            EXPECT_EQ(from_start(), good) << "a fault that was passed over";
        } catch (const Error& error) {
            expect_line(error);
            ++failures;
        }
        EXPECT_EQ(complaints, "");
        complaints.clear();
    });
    RecordProperty("failures", std::to_string(failures) + " of " + std::to_string(tried) + ", at " +
                                   std::to_string(calls) + " calls");
    EXPECT_GT(failures, tried / 2);
}

TEST(VulkanFaults, AFrameThatFailedIsFollowedByAGoodOne) {
    const scene::Scene scene = wall_with_a_lamp();
    std::string complaints;
    gpu::Device device(
        {.select = "", .validation = true, .on_message = [&](const std::string& m) { complaints += m + "\n"; }});
    render::Renderer renderer(device, scene);
    // The eye goes on from the frame before the one that fails.
    const auto eye_after = [&] {
        render(renderer, scene);
        return render(renderer, scene, {16, 8}, 0.1f);
    };
    const std::vector<uint8_t> good = eye_after();
    const auto failing = [&] { render(renderer, scene, {24, 12}, 0.3f); };  // another size: everything is made anew
    uint64_t calls = 0;
    {
        const Armed none(0, VK_SUCCESS);
        failing();
        calls = vesper_fault_count();
    }
    ASSERT_GT(calls, 20u);
    every_fault(calls, {{VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY}}, [&](uint64_t n, VkResult code) {
        render(renderer, scene);
        bool failed = false;
        {
            const Armed armed(n, code);
            try {
                failing();
            } catch (const Error& error) {
                expect_line(error);
                failed = true;
            }
        }
        if (failed) {
            EXPECT_EQ(render(renderer, scene, {16, 8}, 0.1f), good);
        }
        EXPECT_EQ(complaints, "");
        complaints.clear();
    });
}

}  // namespace
}  // namespace vesper::test
