// The shared HDR pictures: the numbers their list states, one picture in several codings, damaged files.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>

#include "io/hdr_image.h"
#include "support/complaints.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::HdrImage, io::read_hdr_image;
namespace fs = std::filesystem;
const fs::path kHdr = shared_data("hdr");

/// Positive luminances, ascending; the weights are those of the list.
std::vector<double> luminances(const HdrImage& image) {
    std::vector<double> found;
    for (size_t i = 0; i < image.rgb.size(); i += 3) {
        const double y = 0.2126 * image.rgb[i] + 0.7152 * image.rgb[i + 1] + 0.0722 * image.rgb[i + 2];
        if (y > 0 && std::isfinite(y)) found.push_back(y);
    }
    std::sort(found.begin(), found.end());
    return found;
}

// The list states luminance of the numbers as stored in the data window. Left out: other primaries, windows that
// differ, a lone G, and pictures with pixels that are not finite.
TEST(HdrShared, HaveTheStatedLuminances) {
    std::ifstream list(kHdr / "README.md");
    if (!list) GTEST_SKIP() << "the shared set is not here";
    const std::regex numbers(R"(Y min\+ (\S+) p1 (\S+) med (\S+) p99 (\S+) max (\S+))"),
        window(R"(data (\S+) disp (\S+))");
    size_t compared = 0;
    for (std::string line; std::getline(list, line);) {
        std::smatch stated, windows;
        if (!std::regex_search(line, stated, numbers) || contains(line, " NaN ") || contains(line, "ch G")) continue;
        if (std::regex_search(line, windows, window) && windows[1] != windows[2]) continue;
        if (contains(line, "chromaticities") && !contains(line, "=(0.63999")) continue;
        const std::string name = line.substr(3, line.find('`', 3) - 3);
        const std::vector<double> found = luminances(read_hdr_image(kHdr / name));
        ASSERT_FALSE(found.empty()) << name;
        const auto percentile = [&](double p) {
            const double at = p * static_cast<double>(found.size() - 1), below = std::floor(at);
            const auto i = static_cast<size_t>(below);
            return found[i] + (at - below) * (found[std::min(i + 1, found.size() - 1)] - found[i]);
        };
        // Three digits are stated; chroma is filtered, so extremes of single pixels differ a little.
        const double extreme = contains(line, "BY,RY,Y") ? 0.05 : 0.006;
        const auto near = [&](double value, int which, double tolerance) {
            const double wanted = std::stod(stated[which]);
            EXPECT_NEAR(value, wanted, tolerance * wanted) << name << ": number " << which;
        };
        if (!contains(line, "BY,RY,Y")) near(found.front(), 1, extreme);
        near(percentile(0.01), 2, 0.02);
        near(percentile(0.5), 3, 0.006);
        near(percentile(0.99), 4, 0.02);
        near(found.back(), 5, extreme);
        ++compared;
    }
    EXPECT_GT(compared, 25u);
}

/// The median of |a - b| / b over the values of two pictures.
double median_difference(const HdrImage& a, const HdrImage& b) {
    EXPECT_EQ(a.rgb.size(), b.rgb.size());
    std::vector<double> differences;
    for (size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); ++i)
        differences.push_back(std::abs(static_cast<double>(a.rgb[i] - b.rgb[i])) /
                              std::max(1e-3, std::abs(static_cast<double>(b.rgb[i]))));
    std::nth_element(differences.begin(), differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2),
                     differences.end());
    return differences.empty() ? 1.0 : differences[differences.size() / 2];
}

TEST(HdrShared, OnePictureInSeveralCodingsIsOnePicture) {
    if (!is_here(kHdr)) GTEST_SKIP() << "the shared set is not here";
    const fs::path colours = kHdr / "openexr-images/Chromaticities", compressed = kHdr / "openexr-tests";
    const HdrImage plain = read_hdr_image(colours / "Rec709.exr");
    EXPECT_LT(median_difference(read_hdr_image(colours / "XYZ.exr"), plain), 0.002);
    EXPECT_LT(median_difference(read_hdr_image(colours / "Rec709_YC.exr"), plain), 0.02);
    EXPECT_LT(median_difference(read_hdr_image(colours / "XYZ_YC.exr"), plain), 0.02);
    const HdrImage zip = read_hdr_image(compressed / "comp_zip.exr");
    for (const char* lossless : {"comp_piz.exr", "comp_rle.exr"})
        EXPECT_EQ(read_hdr_image(compressed / lossless).rgb, zip.rgb) << lossless;
    for (const char* lossy : {"comp_dwaa_v2.exr", "comp_dwab_v2.exr"})
        EXPECT_LT(median_difference(read_hdr_image(compressed / lossy), zip), 0.03) << lossy;
    EXPECT_LT(median_difference(read_hdr_image(kHdr / "polyhaven/dikhololo_night_1k.hdr"),
                                read_hdr_image(kHdr / "polyhaven/dikhololo_night_1k.exr")),
              4e-4);
}

TEST(HdrShared, WindowsAndLevelsAreThoseOfTheFile) {
    if (!is_here(kHdr)) GTEST_SKIP() << "the shared set is not here";
    const fs::path windows = kHdr / "openexr-images/DisplayWindow";
    const HdrImage whole = read_hdr_image(windows / "t01.exr"), cropped = read_hdr_image(windows / "t05.exr"),
                   inside = read_hdr_image(windows / "t08.exr");
    const auto green = [](const HdrImage& image, size_t x, size_t y) {
        return image.rgb[3 * (y * image.width + x) + 1];
    };
    ASSERT_EQ(cropped.width, 340u);
    ASSERT_EQ(cropped.height, 260u);
    ASSERT_EQ(inside.width, 501u);
    for (size_t y = 0; y < 260; y += 7)
        for (size_t x = 0; x < 340; x += 7) {
            EXPECT_EQ(green(cropped, x, y), green(whole, x + 30, y + 20));
            EXPECT_EQ(green(inside, x + 30, y + 40), green(whole, x, y));
        }
    EXPECT_EQ(green(inside, 0, 0), 0);
    const HdrImage nothing = read_hdr_image(windows / "t12.exr");
    EXPECT_TRUE(std::all_of(nothing.rgb.begin(), nothing.rgb.end(), [](float v) { return v == 0; }));
    EXPECT_EQ(read_hdr_image(kHdr / "openexr-images/MultiResolution/ColorCodedLevels.exr").width, 512u);
    EXPECT_THROW(read_hdr_image(kHdr / "openexr-images/v2/LowResLeftView/Trunks.exr"), Error);
}

TEST(HdrShared, EveryDamagedFileGivesAPictureOrAnError) {
    const fs::path root = shared_data("malformed");
    if (!is_here(root)) GTEST_SKIP() << "the shared set is not here";
    size_t pictures = 0, errors = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        if (!entry.is_regular_file()) continue;
        try {
            const HdrImage image = read_hdr_image(entry.path(), {8192, 1u << 24});
            EXPECT_EQ(image.rgb.size(), size_t{3} * image.width * image.height);
            ++pictures;
        } catch (const Error& error) {
            EXPECT_TRUE(contains(error.what(), entry.path().filename().string().substr(0, 60))) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            ++errors;
        }
    }
    EXPECT_GT(errors, 90u);
    EXPECT_LT(pictures, 10u);
}

}  // namespace
}  // namespace vesper::test
