// What cameras say, out of JPEG files made here. SPDX-License-Identifier: MIT
#include "io/exif.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "io/image_file.h"
#include "io/jpeg_files.h"
#include "io/read_file.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::read_exif;

const std::vector<uint8_t> kGrey(8 * 8 * 4, 128);

TEST(Exif, ReadsExposureOfBothByteOrders) {
    for (const bool big : {false, true}) {
        const auto file = jpeg_with(8, 8, kGrey, exif_of(1, 60, 28, 10, 400, big));
        EXPECT_EQ(io::decode_image(file, 100).width, 8u);
        const io::CameraExposure camera = read_exif(file);
        ASSERT_TRUE(camera.seconds && camera.f_number && camera.iso);
        EXPECT_DOUBLE_EQ(*camera.seconds, 1.0 / 60);
        EXPECT_DOUBLE_EQ(*camera.f_number, 2.8);
        EXPECT_DOUBLE_EQ(*camera.iso, 400);
    }
}

TEST(Exif, LeavesOutWhatIsNotThereOrSenseless) {
    const io::CameraExposure manual = read_exif(jpeg_with(8, 8, kGrey, exif_of(2, 1, 0, 0, 100)));
    EXPECT_EQ(manual.seconds, 2.0);
    EXPECT_FALSE(manual.f_number);
    EXPECT_FALSE(read_exif(jpeg_with(8, 8, kGrey, exif_of(1, 0, 28, 10, 0))).seconds);
    EXPECT_FALSE(read_exif(jpeg_with(8, 8, kGrey, exif_of(1, 60, 28, 10, 0))).iso);
    EXPECT_FALSE(read_exif(jpeg_with(8, 8, kGrey)).seconds);
    EXPECT_FALSE(read_exif({}).seconds);
}

TEST(Exif, SurvivesCutAndChangedData) {
    const auto whole = jpeg_with(8, 8, kGrey, exif_of(1, 60, 28, 10, 400));
    for (size_t size = 0; size < 200; ++size) read_exif(std::span(whole).first(size));
    for (size_t i = 2; i < 200; ++i)
        for (int change = 1; change < 256; change *= 2) {
            auto changed = whole;
            changed[i] ^= static_cast<uint8_t>(change);
            const io::CameraExposure camera = read_exif(changed);
            EXPECT_GT(camera.seconds.value_or(1), 0);
        }
    const auto root = shared_data("malformed/image/jpeg-corrupt");
    if (!is_here(root)) GTEST_SKIP() << "the shared set is not here";
    for (const auto& entry : std::filesystem::directory_iterator(root)) read_exif(io::read_file(entry.path(), 1 << 24));
}

}  // namespace
}  // namespace vesper::test
