// The reference of directly seen lamps against what is known in closed form. SPDX-License-Identifier: MIT
#include "passes/luminaires_reference.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "support/sources.h"

namespace vesper::test::luminaires_reference_test {
namespace {

using glm::dvec2, glm::dvec3;
constexpr double kPi = std::numbers::pi;

gpu_scene::View narrow(VkExtent2D extent) {
    return gpu_scene::View::symmetric(extent, 0.6f * float(extent.height) / 1050, glm::mat4(1));
}

TEST(LuminairesReference, AreaWithinAPixel) {
    const std::vector<dvec2> square{{0.25, 0.5}, {1.25, 0.5}, {1.25, 1.5}, {0.25, 1.5}};
    EXPECT_NEAR(reference::area_within(square, 0, 0), 0.375, 1e-15);
    EXPECT_NEAR(reference::area_within(square, 1, 1), 0.125, 1e-15);
    EXPECT_EQ(reference::area_within(square, 2, 0), 0);
    const std::vector<dvec2> triangle{{0, 0}, {1, 0}, {0, 1}};
    EXPECT_NEAR(reference::area_within(triangle, 0, 0), 0.5, 1e-15);
    EXPECT_NEAR(reference::area_within({{-5, -5}, {9, -5}, {9, 9}, {-5, 9}}, 3, 2), 1, 1e-15);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int k = 0; k < 50; ++k) {  // the pixels of a polygon add up to it
        const double angle = unit(random), a = 0.2 + 3 * unit(random), b = 0.2 + 3 * unit(random);
        std::vector<dvec2> box;
        for (const dvec2 corner : {dvec2(-a, -b), dvec2(a, -b), dvec2(a, b), dvec2(-a, b)})
            box.emplace_back(6 + std::cos(angle) * corner.x - std::sin(angle) * corner.y,
                             6 + std::sin(angle) * corner.x + std::cos(angle) * corner.y);
        double sum = 0;
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x) sum += reference::area_within(box, x, y);
        EXPECT_NEAR(sum, 4 * a * b, 1e-12);
    }
}

TEST(LuminairesReference, SolidAnglesOfPixelsAddUp) {
    const gpu_scene::View view = gpu_scene::View::symmetric({8, 8}, float(kPi / 2), glm::mat4(1));  // a face of a cube
    double sum = 0;
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x) sum += reference::solid_angle(view, x, y);
    EXPECT_NEAR(sum, 4 * kPi / 6, 1e-6);
    const std::vector<dvec2> pixel{{2, 3}, {3, 3}, {3, 4}, {2, 4}};
    EXPECT_NEAR(reference::solid_angle(view, pixel), reference::solid_angle(view, 2, 3), 1e-12);
}

TEST(LuminairesReference, SurfacesHideWhatLiesBehind) {
    EXPECT_EQ(reference::seen(0, 50), 1) << "sky";
    EXPECT_EQ(reference::seen(49, 50), 0);
    EXPECT_EQ(reference::seen(50.2, 50), 1);
    EXPECT_NEAR(reference::seen(50.05, 50), 0.5, 1e-6);
}

/// The image of one lamp with nothing before it.
std::vector<dvec3> image_of(const Lamps& lamps, const gpu_scene::View& view) {
    const gpu_scene::LuminaireList list = lamps.seen(view);
    std::vector<dvec3> pixels;
    for (uint32_t y = 0; y < view.extent.height; ++y)
        for (uint32_t x = 0; x < view.extent.width; ++x) pixels.push_back(reference::added(list, x, y, 0).luminance);
    return pixels;
}

// The sum over the image is I(direction) / d^2 for discs and rectangles, facing the eye or not, in the middle of the
// image or in its corner, from many pixels to a thousandth of one.
TEST(LuminairesReference, TheImageHoldsTheIlluminance) {
    const gpu_scene::View view = narrow({96, 64});
    for (const bool round : {false, true})
        for (const double distance : {8.0, 20.0, 75.0, 400.0, 3000.0})
            for (const dvec2 at : {dvec2(0), dvec2(0.012, -0.008)})
                for (const double turn : {0.0, 0.7, 1.3}) {
                    SCOPED_TRACE(std::to_string(round) + ", " + std::to_string(distance) + " m, " +
                                 std::to_string(turn));
                    Lamps lamps;
                    const dvec3 position = distance * dvec3(at, -1);
                    lamps.add(lamp_with_opening(900, 0.19, 0.12, round),
                              aimed(glm::vec3(position), {float(std::sin(turn)), 0, float(std::cos(turn))}));
                    const double d2 = glm::dot(position, position);
                    const double cosine = glm::dot(dvec3(std::sin(turn), 0, std::cos(turn)), -position / std::sqrt(d2));
                    const double wanted = 900 * cosine / d2;
                    EXPECT_NEAR(reference::illuminance(view, image_of(lamps, view)) / wanted, 1, 3e-4);
                }
}

}  // namespace
}  // namespace vesper::test::luminaires_reference_test
