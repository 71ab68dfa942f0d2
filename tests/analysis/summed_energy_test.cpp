// Sums of energy against closed forms. SPDX-License-Identifier: MIT
#include "analysis/summed_energy.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

constexpr analysis::ChannelGrid kGrid{151, 101, 2};
constexpr double kSamplesPerDegree = 20;  // 40 px
constexpr size_t kMiddle = 50 * kGrid.width + 75;

std::vector<double> summed(const std::vector<double>& energies, double area) {
    return analysis::summed_energies(energies, kGrid, kSamplesPerDegree * kGrid.step, area);
}

std::vector<double> envelope(double sigma) {
    std::vector<double> energies;
    for (int y = 0; y < int(kGrid.height); ++y)
        for (int x = 0; x < int(kGrid.width); ++x)
            energies.push_back(std::exp(-std::pow(std::hypot(x - 75, y - 50) / kSamplesPerDegree / sigma, 2)));
    return energies;
}

// 1 in the middle, a half at an edge and a quarter in a corner, as nothing lies beyond.
TEST(SummedEnergy, OfTheSameEverywhereIsTheSame) {
    const std::vector<double> sums = summed(std::vector<double>(kGrid.size(), 1), 1);
    const double itself = 1 / (2 * kSamplesPerDegree);  // of a row, half the weight of a sample on the edge
    EXPECT_NEAR(sums[kMiddle], 1, 1e-4);
    EXPECT_NEAR(sums[75], 0.5 + itself, 1e-4);
    EXPECT_NEAR(sums[0], std::pow(0.5 + itself, 2), 1e-4);
}

// 1 / (1 + area / (pi sigma^2)): reciprocals of areas are summed (Barten 1999).
TEST(SummedEnergy, OfAnEnvelopeIsThatOfItsArea) {
    for (const double sigma : {0.125, 0.25, 0.5})
        for (const double area : {0.1, 0.5, 2.0}) {
            const double expected = 1 / (1 + area / (std::numbers::pi * sigma * sigma));
            EXPECT_NEAR(summed(envelope(sigma), area)[kMiddle] / expected, 1, 1e-3) << sigma << ", " << area;
        }
}

TEST(SummedEnergy, OfAPointFallsAsTheWeightAlikeInAllDirections) {
    std::vector<double> point(kGrid.size());
    point[kMiddle] = 3;
    const std::vector<double> sums = summed(point, 0.5);
    const double cell = 1 / (kSamplesPerDegree * kSamplesPerDegree);
    const auto weight = [&](double samples) {
        return 3 * cell / 0.5 * std::exp(-std::numbers::pi * std::pow(samples / kSamplesPerDegree, 2) / 0.5);
    };
    EXPECT_NEAR(sums[kMiddle], weight(0), 1e-12);
    EXPECT_NEAR(sums[kMiddle + 5], weight(5), 1e-12);
    EXPECT_NEAR(sums[kMiddle + 5 * kGrid.width], weight(5), 1e-12);
    EXPECT_NEAR(sums[kMiddle - 3 * kGrid.width - 4], weight(5), 1e-12);
    EXPECT_EQ(sums[kMiddle + 50], 0) << "beyond the reach";
}

TEST(SummedEnergy, OfOneSampleNeedsNoOther) {
    const std::vector<double> one{5};
    EXPECT_NEAR(analysis::summed_energies(one, {1, 1, 1}, 10, 4)[0], 5 * 0.01 / 4, 1e-15);
}

}  // namespace
}  // namespace vesper::test
