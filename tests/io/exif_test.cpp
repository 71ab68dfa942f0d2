// What cameras say, out of JPEG files made here. SPDX-License-Identifier: MIT
#include "io/exif.h"

#include <cmath>
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

// Tv = -log2 t, Av = 2 log2 N (Exif 2.32, annex C).
TEST(Exif, TakesTimesAndAperturesInApexWhereThereAreNoOthers) {
    const ExifTags apex{0x9201, 10, 0x9202, 5};
    const auto read = [](int32_t over, uint32_t under, int32_t f_over, uint32_t f_under, const ExifTags& tags,
                         bool big = false) {
        const auto exif =
            exif_of(static_cast<uint32_t>(over), under, static_cast<uint32_t>(f_over), f_under, 100, big, tags);
        return read_exif(jpeg_with(8, 8, kGrey, exif));
    };
    for (const bool big : {false, true}) {
        const io::CameraExposure camera = read(6, 1, 3, 1, apex, big);
        ASSERT_TRUE(camera.seconds && camera.f_number);
        EXPECT_DOUBLE_EQ(*camera.seconds, 1.0 / 64);
        EXPECT_DOUBLE_EQ(*camera.f_number, std::sqrt(8.0));
    }
    const io::CameraExposure phone = read(5906, 1000, 169, 100, apex);
    EXPECT_NEAR(phone.seconds.value_or(0), 1.0 / 60, 1e-4);
    EXPECT_NEAR(phone.f_number.value_or(0), 1.8, 0.01);
    const io::CameraExposure night = read(-3, 1, 0, 1, apex);
    EXPECT_DOUBLE_EQ(night.seconds.value_or(0), 8);
    EXPECT_DOUBLE_EQ(night.f_number.value_or(0), 1);
    const io::CameraExposure second = read(0, 10, 4, 1, {0x9201, 10, 0x829d, 5});
    EXPECT_DOUBLE_EQ(second.seconds.value_or(0), 1);
    EXPECT_DOUBLE_EQ(second.f_number.value_or(0), 4) << "FNumber is no APEX value";
    EXPECT_DOUBLE_EQ(read(1, 60, 4, 1, {0x829a, 5, 0x9202, 5}).f_number.value_or(0), 4);
    for (const auto& [over, under] : {std::pair<int32_t, uint32_t>(1, 0), {0, 0}, {2000, 1}, {-2000000000, 1}}) {
        EXPECT_FALSE(read(over, under, 0, 0, apex).seconds) << over;
        EXPECT_FALSE(read(1, 1, over < 0 ? 90 : over, under, apex).f_number) << over;
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
