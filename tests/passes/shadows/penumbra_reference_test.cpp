// The closed form of a penumbra: limits, and sums over a disc. SPDX-License-Identifier: MIT
#include "passes/shadows/penumbra_reference.h"

#include <gtest/gtest.h>

namespace vesper::test::penumbra_reference_test {
namespace {

// An edge at 2 m under a lamp of 0.5 m at 6 m: half of it is seen where the ray by the edge ends, and the penumbra is
// 0.5 m wide.
TEST(PenumbraReference, BeginsAndEndsWithTheDisc) {
    EXPECT_NEAR(reference::past_edge(1.5, 1, 2, 6, 0.5), 0.5, 1e-12);
    EXPECT_EQ(reference::past_edge(1.2499, 1, 2, 6, 0.5), 0);
    EXPECT_GT(reference::past_edge(1.2501, 1, 2, 6, 0.5), 0);
    EXPECT_LT(reference::past_edge(1.7499, 1, 2, 6, 0.5), 1);
    EXPECT_EQ(reference::past_edge(1.7501, 1, 2, 6, 0.5), 1);
}

TEST(PenumbraReference, IsTheSumOverTheDisc) {
    for (const double x : {1.3, 1.45, 1.5, 1.62, 1.7}) {
        size_t seen = 0, all = 0;
        for (double v = -0.4995; v < 0.5; v += 0.001)
            for (double u = -0.4995; u < 0.5; u += 0.001) {
                if (u * u + v * v > 0.25) continue;
                ++all;
                seen += x + (u - x) * 2 / 6 > 1 ? 1 : 0;  // where the ray passes the height of the edge
            }
        EXPECT_NEAR(reference::past_edge(x, 1, 2, 6, 0.5), double(seen) / double(all), 2e-3) << x;
    }
}

}  // namespace
}  // namespace vesper::test::penumbra_reference_test
