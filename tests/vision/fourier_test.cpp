// Transforms of pictures against sums by definition. SPDX-License-Identifier: MIT
#include "vision/fourier.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using vision::Complexes;

Complexes noise(size_t count) {
    Complexes values;
    for (size_t i = 0; i < count; ++i) values.push_back({std::sin(3.7 * double(i * i)), std::cos(2.3 * double(i))});
    return values;
}

TEST(Fourier, SpectrumIsTheSumOfItsDefinition) {
    for (const auto& [width, height] : {std::pair<size_t, size_t>{1, 1}, {1, 6}, {5, 1}, {12, 10}, {7, 9}}) {
        const Complexes picture = noise(width * height), spectrum = vision::spectrum_of(picture, width, height);
        for (size_t u = 0; u < width; ++u)
            for (size_t v = 0; v < height; ++v) {
                std::complex<double> sum = 0;
                for (size_t y = 0; y < height; ++y)
                    for (size_t x = 0; x < width; ++x)
                        sum += picture[y * width + x] *
                               std::polar(1.0, -2 * std::numbers::pi *
                                                   (double(u * x) / double(width) + double(v * y) / double(height)));
                EXPECT_LT(std::abs(spectrum[u * height + v] - sum), 1e-11) << width << " x " << height;  // rounding
            }
    }
}

TEST(Fourier, InverseGivesThePictureBack) {
    const size_t width = 36, height = 25;
    const Complexes picture = noise(width * height),
                    back = vision::picture_of(vision::spectrum_of(picture, width, height), width, height);
    for (size_t i = 0; i < picture.size(); ++i) EXPECT_LT(std::abs(back[i] - picture[i]), 1e-13);
}

TEST(Fourier, FastLengthsAreProductsOfTheStepAndSmallPrimes) {
    EXPECT_EQ(vision::fast_length(1, 1), 1u);
    EXPECT_EQ(vision::fast_length(7, 1), 8u);
    EXPECT_EQ(vision::fast_length(1707, 16), 1728u);  // 16 * 108
    EXPECT_EQ(vision::fast_length(1077, 16), 1152u);  // 16 * 72: 68 to 71 have larger primes
    EXPECT_EQ(vision::fast_length(3, 8), 8u);
}

}  // namespace
}  // namespace vesper::test
