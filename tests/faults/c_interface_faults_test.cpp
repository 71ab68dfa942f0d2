// Faults of Vulkan as the C interface tells them. SPDX-License-Identifier: MIT
#include <cstring>

#include "faults/child.h"
#include "faults/faults.h"
#include "places.h"
#include "support/host_device.h"

namespace vesper::test {
namespace {

TEST(CInterfaceFaults, EachHasItsResult) {
    const std::pair<VkResult, VesperResult> cases[]{{VK_ERROR_OUT_OF_HOST_MEMORY, VESPER_OUT_OF_MEMORY},
                                                    {VK_ERROR_OUT_OF_DEVICE_MEMORY, VESPER_OUT_OF_DEVICE_MEMORY},
                                                    {VK_ERROR_DEVICE_LOST, VESPER_DEVICE_LOST},
                                                    {VK_ERROR_INITIALIZATION_FAILED, VESPER_FAILED}};
    for (const auto& [fault, result] : cases) {
        VesperDevice* device = nullptr;
        VesperError error{};
        vesper_fault_arm(FaultKind::Vulkan, 1, fault);
        EXPECT_EQ(vesper_device_open(nullptr, &device, &error), result) << error.message;
        vesper_fault_arm(FaultKind::None, 0, 0);
        EXPECT_EQ(device, nullptr);
        EXPECT_STRNE(error.message, "");
    }
}

/// A device of the host's with a tone mapper on it, which shows pictures of its images.
class ImageFaults : public testing::Test {
protected:
    static constexpr VkExtent2D kSmall{9, 5}, kLarge{16, 12};

    ImageFaults() {
        const VesperHostDevice lent = host.lent();
        EXPECT_EQ(vesper_device_borrow(&lent, &device, &error), VESPER_OK) << error.message;
        EXPECT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK) << error.message;
        vesper_tone_settings_defaults(&settings, sizeof settings);
    }
    ~ImageFaults() override {
        vesper_tone_mapper_destroy(mapper);
        vesper_device_close(device);
        host->wait(time);
        for (::Image& image : images) host->destroy(image);
    }

    /// Call `fault` of Vulkan fails, from 1; 0: none. `handover` may be null.
    VesperResult map(VkExtent2D extent, uint64_t fault = 0, const VesperHandover* handover = nullptr) {
        const ::Image picture = host->make_image(VK_FORMAT_R32G32B32A32_SFLOAT, extent,
                                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
        const ::Image shown = host->make_image(VK_FORMAT_R8G8B8A8_UNORM, extent,
                                               VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        images.push_back(picture), images.push_back(shown);
        host->submit(
            [&](VkCommandBuffer commands) {
                draw_pixels(commands, picture, extent, std::vector<float>(3 * extent.width * extent.height, 10.0f));
            },
            ++time);
        constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        const VesperImage from = described(picture, VK_FORMAT_R32G32B32A32_SFLOAT, extent, kRead, kRead);
        const VesperImage to = described(shown, VK_FORMAT_R8G8B8A8_UNORM, extent, VK_IMAGE_LAYOUT_UNDEFINED,
                                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        VesperImagePicture given = VESPER_INIT(VesperImagePicture);
        given.image = &from, given.scale = 1, given.vertical_fov = 0.7f;
        vesper_fault_arm(FaultKind::Vulkan, fault, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        const VesperResult result = vesper_tone_map_image(mapper, &settings, &given, 0.1f, &to, handover, &error);
        vesper_fault_arm(FaultKind::None, 0, 0);
        return result;
    }
    std::vector<uint8_t> eye() {
        std::vector<uint8_t> bytes(vesper_eye_size());
        EXPECT_EQ(vesper_tone_mapper_eye(mapper, bytes.data(), &error), VESPER_OK) << error.message;
        return bytes;
    }

    HostDevice host;
    VesperDevice* device = nullptr;
    VesperToneMapper* mapper = nullptr;
    VesperError error{};
    VesperToneSettings settings;
    uint64_t time = 0;
    std::vector<::Image> images;
};

// What an image left of the eye is known though the next one fails, and nobody asked between them: with glare that
// moves, which reads it first, and without; where the next image is of the same size, and where it is of another, for
// which everything is made anew. Only if it is the waiting that fails, nobody knows what came of the image that was
// waited for.
TEST_F(ImageFaults, TheEyeStaysKnownWhenTheNextImageFails) {
    struct Case {
        uint32_t glare;
        VkExtent2D next;
    };
    for (const auto& [glare, next] :
         {Case{VESPER_GLARE_NONE, kSmall}, Case{VESPER_GLARE_NONE, kLarge}, Case{VESPER_GLARE_TEMPORAL, kSmall}}) {
        settings.glare = glare;
        const auto first = [&] {
            ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
            ASSERT_EQ(map(kSmall), VESPER_OK) << error.message;
        };
        first();
        const std::vector<uint8_t> seen = eye();
        ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
        const std::vector<uint8_t> none = eye();
        ASSERT_NE(seen, none);
        first();
        ASSERT_EQ(map(next), VESPER_OK) << error.message;  // makes what a second image under way needs
        size_t known = 0;
        for (uint64_t fault = 1;; ++fault) {
            SCOPED_TRACE("glare " + std::to_string(glare) + ", " + std::to_string(next.width) + " px wide, call " +
                         std::to_string(fault));
            first();  // which nobody asks for
            if (map(next, fault) == VESPER_OK) break;
            const std::string said = error.message;
            const bool waiting = said.starts_with("waiting for the device") || said.starts_with("reading");
            EXPECT_EQ(eye(), waiting ? none : seen) << said;
            known += !waiting;
        }
        EXPECT_GE(known, 5u);
    }
}

// Whatever fails: a call that says so has signalled nothing, and one that says nothing has.
TEST_F(ImageFaults, ACallThatFailsHasHandedNothingOver) {
    ASSERT_EQ(map(kSmall), VESPER_OK) << error.message;
    VkSemaphoreSubmitInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    signal.semaphore = host->timeline(), signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VesperHandover handover = VESPER_INIT(VesperHandover);
    handover.signal_count = 1, handover.signals = &signal;
    size_t failed = 0;
    for (bool faulty = true; faulty; failed += faulty) {
        SCOPED_TRACE("call " + std::to_string(failed + 1));
        signal.value = time + 2;                                                 // behind the picture that map draws
        const VkExtent2D other{kLarge.width + uint32_t(failed), kLarge.height};  // for which all is made anew
        const bool handed_over = map(other, failed + 1, &handover) == VESPER_OK;
        faulty = vesper_fault_count() > failed;
        EXPECT_EQ(handed_over, !faulty) << error.message;
        EXPECT_EQ(vesper_tone_mapper_finish(mapper, nullptr, &error), VESPER_OK);
        host->wait(time);
        uint64_t value = 0;
        check(vkGetSemaphoreCounterValue(host.device(), host->timeline(), &value), "reading a semaphore");
        EXPECT_EQ(value, time + (handed_over ? 1 : 0));
        time = value;
    }
    EXPECT_GT(failed, 10u);
}

// Nothing is destroyed that is in use, though there is no memory to wait with.
TEST_F(ImageFaults, WhatIsUnderWayIsWaitedForWithoutMemory) {
    ASSERT_EQ(map(kSmall), VESPER_OK) << error.message;
    ASSERT_EQ(map(kSmall), VESPER_OK) << error.message;
    ASSERT_EQ(map(kSmall), VESPER_OK) << error.message;
    vesper_fault_arm(FaultKind::Vulkan, 1, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    vesper_tone_mapper_destroy(mapper);
    vesper_fault_arm(FaultKind::None, 0, 0);
    EXPECT_GT(vesper_fault_count(), 0u);
    mapper = nullptr;
}

// Memory of the host that is not there for a scene's file is told as such, not as a mistake of the file's.
TEST(CInterfaceFaults, MemoryThatIsNotThereForASceneIsToldAsSuch) {
    const std::string file = std::string(VESPER_SOURCE_DIR) + "/data/glare/headlamps.gltf";
    VesperScene* scene = nullptr;
    VesperError error{};
    vesper_fault_arm(FaultKind::Memory, 0, 0);
    ASSERT_EQ(vesper_scene_read(file.c_str(), &scene, &error), VESPER_OK) << error.message;
    const uint64_t all = vesper_fault_count();
    vesper_fault_arm(FaultKind::None, 0, 0);
    vesper_scene_destroy(scene);
    size_t named = 0, ended = 0;
    for (uint64_t at = 1; at <= all; at += 1 + at / 20) {
        const auto result = in_child([&] {
            scene = nullptr;
            vesper_fault_arm(FaultKind::Memory, at, 0);
            const VesperResult read = vesper_scene_read(file.c_str(), &scene, &error);
            vesper_fault_arm(FaultKind::None, 0, 0);
            if (read != VESPER_OUT_OF_MEMORY || scene != nullptr) return 2;
            return std::strstr(error.message, "headlamps.gltf: ") != nullptr ? 1 : 0;
        });
        ended += !result.has_value();
        EXPECT_LT(result.value_or(0), 2) << "allocation " << at << " of " << all;
        named += result == 1;
    }
    EXPECT_GT(named, 0u);
    EXPECT_LE(ended, kMostEnds);
}

}  // namespace
}  // namespace vesper::test
