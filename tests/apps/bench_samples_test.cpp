// Statistics of the benchmark on closed forms. SPDX-License-Identifier: MIT
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "samples.h"

namespace vesper::test {
namespace {

std::vector<double> up_to(int last) {
    std::vector<double> values(size_t(last) + 1);
    std::iota(values.begin(), values.end(), 0.0);
    return values;
}

// Of 0, 1 ... n the p-th percentile is n p / 100. 1e-12: a few roundings.
TEST(BenchSamples, PercentilesLieBetweenOrderStatistics) {
    const std::vector<double> ramp = up_to(20);
    for (const double percent : {0.0, 1.0, 5.0, 33.3, 50.0, 95.0, 99.0, 100.0})
        EXPECT_NEAR(bench::percentile(ramp, percent), 0.2 * percent, 1e-12) << percent;
    // R: quantile(c(1, 2, 4, 8), c(.05, .5, .95)) is 1.15, 3, 7.4.
    const std::vector<double> few{1, 2, 4, 8};
    EXPECT_NEAR(bench::percentile(few, 5), 1.15, 1e-12);
    EXPECT_NEAR(bench::percentile(few, 50), 3, 1e-12);
    EXPECT_NEAR(bench::percentile(few, 95), 7.4, 1e-12);
    EXPECT_EQ(bench::percentile(std::vector<double>{7}, 99), 7);
    EXPECT_EQ(bench::percentile({}, 50), 0);
}

TEST(BenchSamples, TheSlowestHundredthIsCountedByItsTime) {
    std::vector<double> frames(200, 10.0);
    frames[198] = 20, frames[199] = 30;  // two of 200
    EXPECT_NEAR(bench::one_percent_low(frames), 2 / 0.05, 1e-12);
    EXPECT_NEAR(bench::one_percent_low(std::vector<double>(100, 10.0)), 100, 1e-12);
    EXPECT_NEAR(bench::one_percent_low(std::vector<double>{10, 40}), 25, 1e-12) << "one frame at least";
    EXPECT_NEAR(bench::one_percent_low(std::span(frames).last(101)), 2 / 0.05, 1e-12)
        << "a hundredth of 101 is rounded up";
    EXPECT_EQ(bench::one_percent_low({}), 0);
}

TEST(BenchSamples, SpreadIsThatOfTheLaps) {
    bench::Samples samples;
    for (const double v : {3.0, 1.0, 2.0}) samples.add(v);
    samples.next_lap();
    for (const double v : {5.0, 4.0, 100.0}) samples.add(v);
    samples.next_lap();  // and nothing in it
    EXPECT_EQ(samples.ascending(), (std::vector<double>{1, 2, 3, 4, 5, 100}));
    const bench::Spread s = samples.spread();
    EXPECT_EQ(s.median, 3.5);
    EXPECT_EQ(s.low, 2);
    EXPECT_EQ(s.high, 5);
    EXPECT_EQ(bench::Samples().spread().high, 0);
}

TEST(BenchSamples, RatiosCarryTheSpreadOfBoth) {
    const bench::Ratio r = bench::ratio({10, 8, 12.5}, {5, 4, 6});
    EXPECT_DOUBLE_EQ(r.median, 0.5);
    EXPECT_DOUBLE_EQ(r.low, 4 / 12.5);
    EXPECT_DOUBLE_EQ(r.high, 6 / 8.0);
    EXPECT_EQ(bench::ratio({0, 0, 0}, {5, 4, 6}).median, 0) << "nothing to relate to";
}

}  // namespace
}  // namespace vesper::test
