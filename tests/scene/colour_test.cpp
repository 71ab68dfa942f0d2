// Colours of black bodies against published chromaticities. SPDX-License-Identifier: MIT
#include "scene/colour.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/error.h"

namespace vesper::test {
namespace {

glm::dvec2 chromaticity(glm::dvec3 c) {
    const glm::dvec3 xyz(0.412391 * c.r + 0.357584 * c.g + 0.180481 * c.b,
                         0.212639 * c.r + 0.715169 * c.g + 0.072192 * c.b,
                         0.019331 * c.r + 0.119195 * c.g + 0.950532 * c.b);
    return {xyz.x / (xyz.x + xyz.y + xyz.z), xyz.y / (xyz.x + xyz.y + xyz.z)};
}

TEST(Colour, FollowsThePlanckianLocus) {
    // Wyszecki and Stiles, "Color Science" (1982), table 1(3.11); 2856 K is CIE illuminant A.
    const struct {
        double kelvin, x, y;
    } published[] = {{2500, 0.4770, 0.4137}, {2856, 0.4476, 0.4074}, {4000, 0.3805, 0.3768},
                     {5000, 0.3451, 0.3516}, {6500, 0.3135, 0.3237}, {10000, 0.2807, 0.2884}};
    for (const auto& p : published) {
        const glm::dvec2 xy = chromaticity(scene::colour_of_temperature(p.kelvin));
        EXPECT_NEAR(xy.x, p.x, 5e-4) << p.kelvin;  // the observer is tabulated in steps of 10 nm
        EXPECT_NEAR(xy.y, p.y, 5e-4) << p.kelvin;
    }
}

TEST(Colour, HasLuminanceOneAndNoNegativePart) {
    for (double kelvin = 1000; kelvin <= 25000; kelvin += 500) {
        const glm::vec3 colour = scene::colour_of_temperature(kelvin);
        EXPECT_NEAR(luminance(colour), 1, 1e-6);
        EXPECT_GE(std::min({colour.r, colour.g, colour.b}), 0);
    }
    EXPECT_THROW(scene::colour_of_temperature(999), Error);
    EXPECT_THROW(scene::colour_of_temperature(25001), Error);
}

TEST(Colour, TemperatureOfABlackBodyIsFoundAgain) {
    for (const double kelvin : {2000.0, 2700.0, 4000.0, 6500.0, 9000.0})
        EXPECT_NEAR(scene::temperature_of(glm::dvec3(scene::colour_of_temperature(kelvin))) / kelvin, 1, 0.02)
            << kelvin;
    EXPECT_EQ(scene::temperature_of({1, 0, 0}), 0);
    EXPECT_EQ(scene::temperature_of({0, 1, 0}), 0);
    EXPECT_NEAR(scene::chromaticity({1, 1, 1}).x, 0.3127, 1e-12);  // D65
    EXPECT_NEAR(scene::chromaticity({1, 1, 1}).y, 0.3290, 1e-12);
    EXPECT_EQ(scene::chromaticity({0, 0, 0}), glm::dvec2(0));
}

}  // namespace
}  // namespace vesper::test
