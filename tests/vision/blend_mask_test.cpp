// Blend masks: PNG files as factors of light. SPDX-License-Identifier: MIT
#include "vision/blend_mask.h"

#include <gtest/gtest.h>

#include "io/image_file.h"
#include "io/png_files.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test::blend_mask_test {
namespace {

vision::BlendMask read(const TempFolder& folder, const std::vector<uint8_t>& file) {
    return vision::read_blend_mask(folder.write("mask.png", {file.begin(), file.end()}));
}

// Codes over the largest, in one division of floats.
TEST(BlendMask, CodesAreLinearInLight) {
    const TempFolder folder;
    const vision::BlendMask narrow = read(folder, png_of(3, 2, 8, PNG_COLOR_TYPE_GRAY, {0, 1, 51, 128, 254, 255}));
    EXPECT_EQ(narrow.name, (folder / "mask.png").string());
    EXPECT_EQ(narrow.width, 3u);
    EXPECT_EQ(narrow.height, 2u);
    EXPECT_EQ(narrow.factors, (std::vector<float>{0, 1 / 255.0f, 0.2f, 128 / 255.0f, 254 / 255.0f, 1}));
    const vision::BlendMask wide = read(folder, png_of(3, 1, 16, PNG_COLOR_TYPE_GRAY, {0, 1, 0x12, 0x34, 0xff, 0xff}));
    EXPECT_EQ(wide.factors, (std::vector<float>{1 / 65535.0f, float(0x1234) / 65535.0f, 1}));
}

TEST(BlendMask, ThreeEqualChannelsAreGrey) {
    const TempFolder folder;
    io::write_png(folder / "rgb.png", 2, 1, std::vector<uint8_t>{7, 7, 7, 0, 255, 255, 255, 0});
    EXPECT_EQ(vision::read_blend_mask(folder / "rgb.png").factors, (std::vector<float>{7 / 255.0f, 1}));
    EXPECT_EQ(read(folder, png_of(1, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA, {1, 2, 1, 2, 1, 2, 255, 255})).factors,
              std::vector<float>{float(0x102) / 65535.0f});
    EXPECT_EQ(read(folder, png_of(2, 1, 8, PNG_COLOR_TYPE_GRAY, {5, 6}, false, 0.45455)).factors,
              (std::vector<float>{5 / 255.0f, 6 / 255.0f}))
        << "a chunk of gamma has no effect";
}

TEST(BlendMask, OthersAreRefused) {
    const TempFolder folder;
    const auto complaint = [&](const std::vector<uint8_t>& file) { return complaint_of([&] { read(folder, file); }); };
    EXPECT_TRUE(contains(complaint(png_of(2, 1, 8, PNG_COLOR_TYPE_RGB, {1, 1, 1, 9, 9, 8})),
                         "mask.png: pixel 1, 0 has a colour"));
    EXPECT_TRUE(contains(complaint(png_of(1, 2, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {1, 255, 2, 254})),
                         "pixel 0, 1 can be seen through"));
    EXPECT_TRUE(contains(complaint({}), "mask.png: is no PNG"));
    std::vector<uint8_t> cut = png_of(64, 64, 8, PNG_COLOR_TYPE_GRAY, std::vector<uint8_t>(64 * 64, 3));
    cut.resize(cut.size() / 2);
    EXPECT_TRUE(contains(complaint(cut), "mask.png: PNG: "));
    const std::string missing = complaint_of([&] { vision::read_blend_mask(folder / "missing.png"); });
    EXPECT_TRUE(contains(missing, "missing.png"));
    EXPECT_EQ(missing.find("missing.png"), missing.rfind("missing.png")) << "named once";
}

}  // namespace
}  // namespace vesper::test::blend_mask_test
