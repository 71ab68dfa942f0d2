// Saliency: what can be said of it by hand, and what pops out. SPDX-License-Identifier: MIT
#include "passes/saliency_reference.h"

#include <random>

#include <gtest/gtest.h>

namespace vesper::reference::saliency_reference_test {
namespace {

struct Scene {
    int width, height;
    std::vector<dvec3> pixels;

    Scene(int w, int h, dvec3 rgb) : width(w), height(h), pixels(size_t(w) * size_t(h), rgb) {}
    void fill(int x, int y, int w, int h, dvec3 rgb) {
        for (int v = y; v < y + h; ++v)
            for (int u = x; u < x + w; ++u) pixels[size_t(v) * size_t(width) + size_t(u)] = rgb;
    }
    void disc(double x, double y, double radius, dvec3 rgb) {
        for (int v = 0; v < height; ++v)
            for (int u = 0; u < width; ++u)
                if (std::hypot(u + 0.5 - x, v + 0.5 - y) < radius) fill(u, v, 1, 1, rgb);
    }
    std::array<SaliencyMap, 4> saliency() const {
        return reference::saliency(std::span<const dvec3>(pixels), width, height);
    }
};

/// Where a map is greatest, px.
dvec2 greatest(const SaliencyMap& map) {
    const auto i = int(std::max_element(map.values.begin(), map.values.end()) - map.values.begin());
    return 16.0 * dvec2(i % map.width + 0.5, i / map.width + 0.5);
}

TEST(SaliencyReference, NothingStandsOutOfEvenLight) {
    for (const dvec3 rgb : {dvec3(0), dvec3(1e-3), dvec3(3, 1, 0.2), dvec3(1e5)})
        for (const SaliencyMap& map : Scene(257, 300, rgb).saliency()) EXPECT_LT(map.greatest(), 1e-20);
}

// A grating of 2 on 10 cd/m^2 with the period of a filter. At a crest the odd filter has nothing; the even one has its
// cosines' squares, less what frees it of a mean, and the Gaussian sees its cosines.
TEST(SaliencyReference, FiltersAnswerToTheirStripes) {
    SaliencyMap light(40, 40), pixels(40, 40);
    std::fill(pixels.values.begin(), pixels.values.end(), 1.0);
    double gauss = 0, squares = 0, cosines = 0;  // along one axis
    for (int i = -4; i <= 4; ++i) {
        const double g = std::exp(-i * i * 9 / 98.0), c = std::cos(2 * std::numbers::pi / 7 * i);
        gauss += g, cosines += g * c, squares += g * c * c;
    }
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) light.at(x, y) = 10 + 2 * std::cos(2 * std::numbers::pi / 7 * (x - 20));
    const auto at = [&](double degrees) { return oriented_contrast(light, pixels, 20, 20, degrees); };
    const double mean = 10 + 2 * cosines / gauss + 1.38e-3;
    EXPECT_NEAR(at(0), 2 * (squares - cosines * cosines / gauss) / gauss / mean, 1e-12);
    EXPECT_NEAR(at(90), 0, 1e-12);
    EXPECT_NEAR(at(45), at(135), 1e-12);
    EXPECT_GT(at(0), 3 * at(45));
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) light.at(x, y) = 2 + std::cos(2 * std::numbers::pi / 7 * std::sqrt(0.5) * (x + y));
    EXPECT_GT(at(45), 8 * at(135));
    std::fill(light.values.begin(), light.values.end(), 0.01);
    light.at(22, 21) = 1e5;
    EXPECT_LT(at(0), 1.2) << "beside a lamp: the even filter is at most 1 and its mean";
}

// (M - m)^2 by hand: peaks 4, 2 and 1, and one of 0.2 that is too low to count: m = 1.5, ((4 - 1.5) / 4)^2 / 4.
TEST(SaliencyReference, PromotionIsThatOfThePaper) {
    SaliencyMap map(9, 3);
    map.at(0, 1) = 4, map.at(2, 1) = 2, map.at(4, 1) = 1, map.at(6, 1) = 0.2, map.at(7, 1) = 0.1;
    EXPECT_NEAR(promoted(map).at(0, 1), 2.5 * 2.5 / 16, 1e-15);
    EXPECT_NEAR(promoted(map).at(6, 1), 2.5 * 2.5 / 16 * 0.05, 1e-15);
    // A peak of two equal texels is one peak, and alone it is promoted whole.
    SaliencyMap flat(5, 2);
    flat.at(2, 0) = flat.at(3, 0) = flat.at(2, 1) = 7;
    EXPECT_EQ(promoted(flat).greatest(), 1);
    for (double& value : flat.values) value *= 1e-4 / 7;
    EXPECT_NEAR(promoted(flat).greatest(), 1e-6, 1e-18) << "too little to be stretched: (0.01)^2 times 0.01";
}

// A square that fills a texel of level 4, alone: 100 on 1 cd/m^2. The surround at level 7 is 1 + 99 / 64 in the texel
// that holds it and 1 elsewhere.
TEST(SaliencyReference, ContrastIsRelativeToTheSurround) {
    Scene scene(512, 384, dvec3(1));
    scene.fill(128 + 48, 128 + 48, 16, 16, dvec3(100));
    const std::span<const dvec3> pixels(scene.pixels);
    const SaliencyLevel of = saliency_level(pixels, 512, 384, 4), about = saliency_level(pixels, 512, 384, 7);
    const SaliencyMap map = contrast(of.plain[0], about.plain[0], of, about, relative, 1, 8);
    const double near =
        (8 + 3 + 0.5) / 8 - 0.5;  // where texel (11, 11) lies on the surround's grid, of which (1, 1) has it
    const double surround = 1 + near * near * 99 / 64;
    EXPECT_NEAR(map.at(11, 11), (100 - surround) / (surround + 1.38e-3), 1e-9);
    EXPECT_NEAR(map.at(30, 2), 0, 1e-12);
}

TEST(SaliencyReference, ABrightDiscIsThePeak) {
    for (const double background : {0.01, 30.0}) {
        Scene scene(400, 320, dvec3(background));
        scene.disc(264, 120, 7, dvec3(20 * background));
        const auto maps = scene.saliency();
        EXPECT_LT(glm::distance(greatest(maps[0]), dvec2(264, 120)), 17) << background;
        EXPECT_GT(maps[1].greatest(), 0.9);
        EXPECT_LT(maps[2].greatest(), background < 1 ? 0.2 : 1e-6) << "grey, but for what cones do not see";
    }
}

/// Bars in rows and columns; the one at (4, 2) has another colour, another orientation, or is as the others.
Scene bars(bool coloured, bool turned) {
    Scene scene(512, 384, dvec3(1));
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 8; ++i) {
            const bool odd = i == 4 && j == 2;
            // Red and green of one luminance, 2 cd/m^2.
            const dvec3 rgb = coloured ? (odd ? dvec3(2 / 0.212639, 0, 0) : dvec3(0, 2 / 0.715169, 0)) : dvec3(5);
            const int x = 64 * i + 32, y = 64 * j + 32;
            if (odd && turned)
                scene.fill(x - 16, y - 4, 32, 8, rgb);
            else
                scene.fill(x - 4, y - 16, 8, 32, rgb);
        }
    return scene;
}

TEST(SaliencyReference, TheOddOnePopsOut) {
    const dvec2 odd(64 * 4 + 32, 64 * 2 + 32);
    EXPECT_LT(glm::distance(greatest(bars(true, false).saliency()[0]), odd), 24) << "of another colour";
    EXPECT_LT(glm::distance(greatest(bars(false, true).saliency()[0]), odd), 24) << "of another orientation";
}

TEST(SaliencyReference, FactorsOnLuminanceChangeNothing) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> decades(1, 4), tint(0.3, 1.5);
    Scene scene(300, 260, dvec3(0));
    for (dvec3& p : scene.pixels) p = std::pow(10, decades(random)) * dvec3(tint(random), tint(random), tint(random));
    const auto maps = scene.saliency();
    for (dvec3& p : scene.pixels) p *= 1000;
    const auto brighter = scene.saliency();
    // What is left is of the floors: 1.38e-3 and 0.00562 in some hundred cd/m^2.
    for (size_t k = 0; k < 4; ++k)
        for (size_t i = 0; i < maps[k].values.size(); ++i)
            ASSERT_NEAR(brighter[k].values[i], maps[k].values[i], 2e-3) << k << " " << i;
}

}  // namespace
}  // namespace vesper::reference::saliency_reference_test
