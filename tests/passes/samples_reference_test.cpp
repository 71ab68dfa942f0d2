// Means of samples, and areas, of which the results are known. SPDX-License-Identifier: MIT
#include "passes/samples_reference.h"

#include <gtest/gtest.h>

namespace vesper::test::samples_reference_test {
namespace {

TEST(SamplesReference, TheMeanIsThatOfTheSamples) {
    const auto mean = reference::mean_of_samples({{{1, 2, 3, 1}, {0, 0, 1e8f, 1}}, {{3, 4, 5, 1}, {0, 0, 1, 1}}});
    EXPECT_EQ(mean[0], glm::dvec3(2, 3, 4));
    EXPECT_EQ(mean[1], glm::dvec3(0, 0, 50000000.5));
}

TEST(SamplesReference, HalfPlanesCoverWhatTheyDo) {
    EXPECT_DOUBLE_EQ(reference::covered_by_half_plane({1, 0}, 0.25), 0.75);
    EXPECT_DOUBLE_EQ(reference::covered_by_half_plane({0, -1}, -0.4), 0.1);
    EXPECT_DOUBLE_EQ(reference::covered_by_half_plane({1, 0}, 2), 1);
    EXPECT_DOUBLE_EQ(reference::covered_by_half_plane({1, 0}, -2), 0);
    const double root = std::sqrt(0.5);  // a corner: a right triangle
    EXPECT_NEAR(reference::covered_by_half_plane({root, root}, 0), 0.5, 1e-15);
    EXPECT_NEAR(reference::covered_by_half_plane({root, root}, -root / 2), 0.125, 1e-15);
}

}  // namespace
}  // namespace vesper::test::samples_reference_test
