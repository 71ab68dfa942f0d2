// Pictures in windows: codes arrive unchanged, other sizes are scaled as said, and instruments lie over them.
// SPDX-License-Identifier: MIT
#include "window/presenter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "gpu/memory.h"
#include "graph/executor.h"

namespace vesper::test {
namespace {

using window::Scaling;

class PresenterTest : public testing::Test {
protected:
    std::string complaints;
    gpu::Device device{{.select = "",
                        .as_least = std::getenv("VESPER_TEST_AS_LEAST") != nullptr,
                        .validation = true,
                        .on_message = [this](const std::string& message) { complaints += message + "\n"; }}};
    std::vector<uint8_t> letters = std::vector<uint8_t>(4, 255);
    window::Presenter presenter{device, {2, 2}, letters};

    ~PresenterTest() override { EXPECT_EQ(complaints, ""); }

    /// What an image of a window would hold, as words of its format.
    std::vector<uint32_t> drawn(VkFormat format, VkExtent2D window, const window::Picture& picture, Scaling scaling,
                                const window::Overlay& overlay = {}, bool hdr10 = false) {
        const gpu::OwnedImage image = gpu::make_image(
            device,
            gpu::image_info(format, window, 1, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
        gpu::Arena arena(device);
        arena.bind(image.get());
        const gpu::OwnedImageView view = gpu::make_view(device, image.get(), format);
        const uint64_t bytes = uint64_t(window.width) * window.height * 4;
        const gpu::HostBuffer back(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   gpu::HostBuffer::Direction::FromDevice);
        device.run_once([&](VkCommandBuffer commands) {
            const auto change = [&](VkImageLayout from, VkImageLayout to) {
                const VkImageMemoryBarrier2 barrier{
                    .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                    .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                    .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                    .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                    .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                    .oldLayout = from,
                    .newLayout = to,
                    .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                    .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                    .image = image.get(),
                    .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
                const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                                  .imageMemoryBarrierCount = 1,
                                                  .pImageMemoryBarriers = &barrier};
                vkCmdPipelineBarrier2(commands, &dependency);
            };
            change(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
            presenter.draw(commands, {view.get(), window, format, hdr10, 0}, picture, scaling, overlay);
            change(VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                         .imageExtent = {window.width, window.height, 1}};
            vkCmdCopyImageToBuffer(commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, back.buffer(), 1,
                                   &copy);
            const VkMemoryBarrier2 host{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                        .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                        .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                        .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                        .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
            const VkDependencyInfo dependency{
                .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &host};
            vkCmdPipelineBarrier2(commands, &dependency);
        });
        back.invalidate();
        std::vector<uint32_t> words(bytes / 4);
        std::memcpy(words.data(), back.data(), bytes);
        return words;
    }
};

/// Every code of every channel, in pictures of any size.
std::vector<uint32_t> words_of(VkExtent2D extent, uint32_t bits) {
    std::vector<uint32_t> words;
    const uint32_t most = (1u << bits) - 1;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i)
        words.push_back((i & most) | ((i * 7 + 3) & most) << bits | ((i * 31 + 5) & most) << 2 * bits |
                        (bits == 8 ? 255u << 24 : 3u << 30));
    return words;
}

window::Picture picture_of(const std::vector<uint32_t>& words, VkExtent2D extent, uint32_t bits = 8) {
    return {{reinterpret_cast<const uint8_t*>(words.data()), words.size() * 4}, extent, bits};
}

uint32_t swapped(uint32_t word) { return (word & 0xff00ff00u) | (word & 0xffu) << 16 | (word >> 16 & 0xffu); }
int channel(uint32_t word, int which) { return int(word >> 8 * which & 0xff); }

// A frame's own image shows what its codes on the host would, to the bit, also where pixels are averaged.
TEST_F(PresenterTest, ImagesShowWhatTheirCodesShow) {
    graph::Executor executor(device);
    for (const uint32_t bits : {8u, 10u}) {
        const VkExtent2D extent{37, 23}, window{bits == 8 ? 37u : 90u, 61};
        std::vector<uint32_t> words;
        for (uint32_t i = 0; i < extent.width * extent.height; ++i)
            words.push_back(2654435761u * (i + 1) | (bits == 8 ? 0xff000000u : 0xc0000000u));
        window::PictureImage image(device);
        graph::FrameGraph frame;
        frame.copy("show", frame.upload("codes", words), frame.target("shown", image.target(extent, bits)));
        executor.run(frame);
        const window::Picture of_host{{reinterpret_cast<const uint8_t*>(words.data()), 4 * words.size()}, extent, bits};
        const VkFormat format = bits == 8 ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_A2B10G10R10_UNORM_PACK32;
        for (const Scaling scaling : {Scaling::Fit, Scaling::Whole})
            EXPECT_EQ(drawn(format, window, image.picture(), scaling), drawn(format, window, of_host, scaling)) << bits;
    }
}

TEST_F(PresenterTest, CodesArriveUnchanged) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, VkExtent2D{7, 5}, VkExtent2D{64, 17}}) {
        const auto words = words_of(extent, 8);
        EXPECT_EQ(drawn(VK_FORMAT_R8G8B8A8_UNORM, extent, picture_of(words, extent), Scaling::Fit), words);
        auto blue_first = words;
        for (uint32_t& word : blue_first) word = swapped(word);
        EXPECT_EQ(drawn(VK_FORMAT_B8G8R8A8_UNORM, extent, picture_of(words, extent), Scaling::Whole), blue_first);
    }
}

TEST_F(PresenterTest, TenBitsArriveUnchanged) {
    const VkExtent2D extent{64, 16};  // all 1024
    const auto words = words_of(extent, 10);
    EXPECT_EQ(drawn(VK_FORMAT_A2B10G10R10_UNORM_PACK32, extent, picture_of(words, extent, 10), Scaling::Fit, {}, true),
              words);
}

TEST_F(PresenterTest, WholeMultiplesRepeatPixelsAmidBlack) {
    const VkExtent2D extent{3, 2}, window{11, 8};  // three times, with a column and a row of black on either side
    const auto words = words_of(extent, 8);
    const auto shown = drawn(VK_FORMAT_R8G8B8A8_UNORM, window, picture_of(words, extent), Scaling::Whole);
    for (uint32_t y = 0; y < window.height; ++y)
        for (uint32_t x = 0; x < window.width; ++x) {
            const bool inside = x >= 1 && x < 10 && y >= 1 && y < 7;
            EXPECT_EQ(shown[y * window.width + x],
                      inside ? words[(y - 1) / 3 * extent.width + (x - 1) / 3] : 0xff000000u)
                << x << "," << y;
        }
}

TEST_F(PresenterTest, HalfTheSizeIsATent) {
    // Weights of a tent of two pixels' reach, at the middle between four: 1/8, 3/8, 3/8, 1/8 along each side.
    const VkExtent2D extent{8, 8}, window{4, 4};
    const auto words = words_of(extent, 8);
    const auto shown = drawn(VK_FORMAT_R8G8B8A8_UNORM, window, picture_of(words, extent), Scaling::Fit);
    const double weights[] = {0.125, 0.375, 0.375, 0.125};
    for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (uint32_t j = 0; j < 4; ++j)
            for (uint32_t i = 0; i < 4; ++i) sum += weights[i] * weights[j] * channel(words[(1 + j) * 8 + 1 + i], c);
        EXPECT_NEAR(channel(shown[1 * 4 + 1], c), sum, 0.51) << c;
    }
}

TEST_F(PresenterTest, PicturesThatGrowAreLinearBetweenTheMiddlesOfPixels) {
    const VkExtent2D extent{4, 2}, window{10, 5};
    const auto words = words_of(extent, 8);
    const auto shown = drawn(VK_FORMAT_R8G8B8A8_UNORM, window, picture_of(words, extent), Scaling::Fit);
    const auto at = [&](int x, int y, int c) {
        return double(channel(words[size_t(std::clamp(y, 0, 1) * 4 + std::clamp(x, 0, 3))], c));
    };
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 10; ++x) {
            const double u = (x + 0.5) * 0.4 - 0.5, v = (y + 0.5) * 0.4 - 0.5, s = u - std::floor(u),
                         t = v - std::floor(v);
            const int i = int(std::floor(u)), j = int(std::floor(v));
            for (int c = 0; c < 3; ++c) {
                const double want = (1 - t) * ((1 - s) * at(i, j, c) + s * at(i + 1, j, c)) +
                                    t * ((1 - s) * at(i, j + 1, c) + s * at(i + 1, j + 1, c));
                EXPECT_NEAR(channel(shown[size_t(y * 10 + x)], c), want, 0.51) << x << "," << y << " channel " << c;
            }
        }
}

TEST_F(PresenterTest, AFlatPictureStaysFlatAtAnySize) {
    const VkExtent2D extent{13, 9};
    const std::vector<uint32_t> words(13 * 9, 0xff5a3c11u);
    for (const VkExtent2D window : {VkExtent2D{1, 1}, VkExtent2D{5, 3}, VkExtent2D{31, 57}}) {
        const window::Placement at = window::place(extent, window, Scaling::Fit);
        const auto shown = drawn(VK_FORMAT_R8G8B8A8_UNORM, window, picture_of(words, extent), Scaling::Fit);
        for (uint32_t y = 0; y < window.height; ++y)
            for (uint32_t x = 0; x < window.width; ++x) {
                const bool inside = int(x) >= at.area.offset.x && x < at.area.offset.x + at.area.extent.width &&
                                    int(y) >= at.area.offset.y && y < at.area.offset.y + at.area.extent.height;
                EXPECT_EQ(shown[y * window.width + x], inside ? words[0] : 0xff000000u);
            }
    }
}

TEST_F(PresenterTest, InstrumentsLieOverThePictureWithinTheirClips) {
    const VkExtent2D extent{8, 4};
    const std::vector<uint32_t> words(32, 0xff000000u);
    // A square over all, half opaque white, in a clip that leaves the window.
    const window::Overlay overlay{.vertices = {{{0, 0}, {0.5f, 0.5f}, 0x80ffffffu},
                                               {{8, 0}, {0.5f, 0.5f}, 0x80ffffffu},
                                               {{8, 4}, {0.5f, 0.5f}, 0x80ffffffu},
                                               {{0, 4}, {0.5f, 0.5f}, 0x80ffffffu}},
                                  .indices = {0, 1, 2, 0, 2, 3},
                                  .batches = {{0, 6, {{2, 1}, {100, 2}}}, {0, 6, {{8, 0}, {1, 1}}}}};
    const auto shown = drawn(VK_FORMAT_R8G8B8A8_UNORM, extent, picture_of(words, extent), Scaling::Fit, overlay);
    for (uint32_t y = 0; y < 4; ++y)
        for (uint32_t x = 0; x < 8; ++x)
            EXPECT_EQ(shown[y * 8 + x], x >= 2 && y >= 1 && y < 3 ? 0xff808080u : 0xff000000u) << x << "," << y;
}

/// A triangle of one colour (red in the lowest bits) over a window of 2 x 2 px.
window::Overlay all_over(uint32_t colour) {
    return {.vertices = {{{-2, -2}, {0.5f, 0.5f}, colour},
                         {{6, -2}, {0.5f, 0.5f}, colour},
                         {{-2, 6}, {0.5f, 0.5f}, colour}},
            .indices = {0, 1, 2},
            .batches = {{0, 3, {{0, 0}, {2, 2}}}}};
}

TEST_F(PresenterTest, WhiteOfInstrumentsIsGraphicsWhiteInHdr10) {
    const uint32_t word = drawn(VK_FORMAT_A2B10G10R10_UNORM_PACK32, {2, 2}, {}, Scaling::Fit, all_over(~0u), true)[3];
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(int(word >> 10 * c & 1023), 594, 1) << c;  // 203 cd/m^2 are 58 % of PQ (ITU-R BT.2408)
}

// Codes of IEC 61966-2-1 as light, in the primaries of Rec. 2020 (ITU-R BT.2087), of which white has 203 cd/m^2, as
// codes of SMPTE ST 2084.
TEST_F(PresenterTest, ColoursOfInstrumentsKeepTheirLightInHdr10) {
    const double to_2020[3][3]{
        {0.627404, 0.329283, 0.043313}, {0.069097, 0.919540, 0.011362}, {0.016391, 0.088013, 0.895595}};
    for (const std::array<int, 3>& codes : {std::array{220, 90, 6}, {8, 160, 70}, {40, 3, 255}}) {
        double light[3];
        for (size_t c = 0; c < 3; ++c) {
            const double code = codes[c] / 255.0;
            light[c] = code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
        }
        const uint32_t colour = 0xff000000u | uint32_t(codes[2]) << 16 | uint32_t(codes[1]) << 8 | uint32_t(codes[0]);
        const uint32_t word =
            drawn(VK_FORMAT_A2B10G10R10_UNORM_PACK32, {2, 2}, {}, Scaling::Fit, all_over(colour), true)[3];
        for (int c = 0; c < 3; ++c) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) sum += to_2020[c][k] * light[k];
            const double y = std::pow(203 * sum / 10000, 2610.0 / 16384),
                         code = std::pow((3424.0 / 4096 + 2413.0 / 128 * y) / (1 + 2392.0 / 128 * y), 2523.0 / 32);
            EXPECT_NEAR(int(word >> 10 * c & 1023), 1023 * code, 1) << codes[0] << ", channel " << c;
        }
    }
}

TEST(Placement, IsCentredAndNeverEmpty) {
    const auto is = [](const window::Placement& p, VkRect2D area, uint32_t times) {
        EXPECT_EQ(p.area.offset.x, area.offset.x);
        EXPECT_EQ(p.area.offset.y, area.offset.y);
        EXPECT_EQ(p.area.extent.width, area.extent.width);
        EXPECT_EQ(p.area.extent.height, area.extent.height);
        EXPECT_EQ(p.times, times);
    };
    is(window::place({100, 50}, {100, 50}, Scaling::Fit), {{0, 0}, {100, 50}}, 1);
    is(window::place({100, 50}, {200, 200}, Scaling::Fit), {{0, 50}, {200, 100}}, 2);
    is(window::place({100, 50}, {250, 200}, Scaling::Fit), {{0, 37}, {250, 125}}, 0);
    is(window::place({100, 50}, {250, 200}, Scaling::Whole), {{25, 50}, {200, 100}}, 2);
    is(window::place({100, 50}, {60, 300}, Scaling::Whole), {{0, 135}, {60, 30}}, 0);
    is(window::place({4000, 10}, {20, 20}, Scaling::Fit), {{0, 9}, {20, 1}}, 0);
}

}  // namespace
}  // namespace vesper::test
