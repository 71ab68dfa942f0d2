// Faults of Vulkan as the C interface tells them. SPDX-License-Identifier: MIT
#include "faults/faults.h"
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

// Glare that moves waits for the frame before: what that left of the eye is known though the next one fails, and nobody asked between them.
TEST(CInterfaceFaults, TheEyeStaysKnownWhenTheNextImageFails) {
    constexpr VkExtent2D kSmall{9, 5}, kLarge{16, 12};
    HostDevice host;
    const VesperHostDevice lent = host.lent();
    VesperDevice* device = nullptr;
    VesperToneMapper* mapper = nullptr;
    VesperError error{};
    ASSERT_EQ(vesper_device_borrow(&lent, &device, &error), VESPER_OK) << error.message;
    ASSERT_EQ(vesper_tone_mapper_create(device, &mapper, &error), VESPER_OK) << error.message;
    VesperToneSettings settings;
    vesper_tone_settings_defaults(&settings, sizeof settings);
    settings.glare = VESPER_GLARE_TEMPORAL;
    uint64_t time = 0;
    std::vector<::Image> images;
    const auto map = [&](VkExtent2D extent) {
        const ::Image picture = host->make_image(VK_FORMAT_R32G32B32A32_SFLOAT, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
        const ::Image shown = host->make_image(VK_FORMAT_R8G8B8A8_UNORM, extent, VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        images.push_back(picture), images.push_back(shown);
        host->submit([&](VkCommandBuffer commands) { draw_pixels(commands, picture, extent, std::vector<float>(3 * extent.width * extent.height, 10.0f)); }, ++time);
        constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        const VesperImage from = described(picture, VK_FORMAT_R32G32B32A32_SFLOAT, extent, kRead, kRead);
        const VesperImage to = described(shown, VK_FORMAT_R8G8B8A8_UNORM, extent, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        VesperImagePicture given = VESPER_INIT(VesperImagePicture);
        given.image = &from, given.scale = 1, given.vertical_fov = 0.7f;
        if (extent.width == kLarge.width) vesper_fault_arm(FaultKind::Vulkan, 5, VK_ERROR_OUT_OF_DEVICE_MEMORY);
        const VesperResult result = vesper_tone_map_image(mapper, &settings, &given, 0.1f, &to, nullptr, &error);
        vesper_fault_arm(FaultKind::None, 0, 0);
        return result;
    };
    const auto eye = [&] {
        std::vector<uint8_t> bytes(vesper_eye_size());
        EXPECT_EQ(vesper_tone_mapper_eye(mapper, bytes.data(), &error), VESPER_OK) << error.message;
        return bytes;
    };
    const std::vector<uint8_t> none = eye();
    ASSERT_EQ(map(kSmall), VESPER_OK) << error.message;
    const std::vector<uint8_t> seen = eye();
    EXPECT_NE(seen, none);
    ASSERT_EQ(vesper_tone_mapper_reset(mapper, &error), VESPER_OK);
    ASSERT_EQ(map(kSmall), VESPER_OK) << error.message;  // not asked for
    ASSERT_EQ(map(kLarge), VESPER_OUT_OF_DEVICE_MEMORY) << error.message;
    EXPECT_EQ(eye(), seen);
    vesper_tone_mapper_destroy(mapper);
    vesper_device_close(device);
    host->wait(time);
    for (::Image& image : images) host->destroy(image);
}

}  // namespace
}  // namespace vesper::test
