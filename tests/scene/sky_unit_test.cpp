// Sky pictures that state no unit: their reading is told. SPDX-License-Identifier: MIT
#include "support/conversion.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// A uniform Radiance picture of 4 x 2 px, R = G = B = L = 128.5 / 128 * 2^(exponent - 129). Each pixel above the
/// horizon has pi / 2 sr at 45 degrees, so that the ground has 2 pi sin(45 deg) L lx.
std::string uniform_sky(char exponent, const std::string& header = "") {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + header + "\n-Y 2 +X 4\n";
    for (int pixel = 0; pixel < 8; ++pixel) text += std::string(3, char(128)) + exponent;
    return text;
}

class SkyUnitTest : public ConversionTest {
protected:
    SkyUnitTest() { street_.show({{"attributes", {{"POSITION", street_.vec3({0, 0, 0, 20, 0, 0, 0, 20, 0})}}}}); }
    std::vector<std::string> warnings_of(json sky, const std::string& picture) {
        folder_.write("sky.hdr", picture);
        sky["image"] = "sky.hdr";
        return convert_with({{"sky", sky}}).warnings;
    }
};

constexpr const char* kSilent = "how much its value 1 is";

TEST_F(SkyUnitTest, IsToldWhereNothingStatesIt) {
    const auto plain = warnings_of(json::object(), uniform_sky(char(129)));
    EXPECT_TRUE(mentions(plain, "sky: 'sky.hdr': does not say how much its value 1 is")) << json(plain);
    EXPECT_TRUE(mentions(plain, "taken for 1 cd/m^2, which makes 1.004 cd/m^2 in the mean and 4.46 lx")) << json(plain);
    EXPECT_TRUE(
        mentions(warnings_of(json::object(), uniform_sky(char(132))), "makes 8.031 cd/m^2 in the mean and 35.68 lx"));
    EXPECT_TRUE(mentions(warnings_of(json::object(), uniform_sky(char(129), "EXPOSURE=0.5\n")),
                         "makes 2.008 cd/m^2 in the mean and 8.92 lx"));
    EXPECT_TRUE(mentions(warnings_of({{"rotation_deg", 90}}, uniform_sky(char(129))), kSilent));
}

TEST_F(SkyUnitTest, IsNotToldWhereTheRuleStatesIt) {
    for (const char* key : {"scale", "luminance_cd_m2", "illuminance_lx"})
        EXPECT_FALSE(mentions(warnings_of({{key, 0.02}}, uniform_sky(char(129))), kSilent)) << key;
}

}  // namespace
}  // namespace vesper::test
