// When a window offers a faster set of settings. SPDX-License-Identifier: MIT
#include "window/pace.h"

#include <gtest/gtest.h>

namespace vesper::test::pace_test {
namespace {

using drive::Pace, render::Quality;

void show(Pace& pace, double rate, double seconds) {
    for (double t = 0; t < seconds; t += 1 / rate) pace.add(1 / rate);
}

TEST(Pace, OffersTheNextFasterSetWherePicturesAreSlow) {
    Pace pace;
    EXPECT_FALSE(pace.offer(Quality::Exact));
    show(pace, 19, 2.5);
    EXPECT_TRUE(pace.is_slow());
    EXPECT_EQ(pace.offer(Quality::Exact), Quality::Standard);
    EXPECT_EQ(pace.offer(Quality::Standard), Quality::Interactive);
    EXPECT_EQ(pace.offer(Quality::Interactive), Quality::Fast);
    EXPECT_FALSE(pace.offer(Quality::Fast)) << "nothing is faster";
    EXPECT_FALSE(pace.crawls());
    show(pace, 3.5, 4);
    EXPECT_TRUE(pace.crawls());
    show(pace, 4.5, 5);
    EXPECT_FALSE(pace.crawls());
    EXPECT_TRUE(pace.is_slow());
}

TEST(Pace, IsTheMeanOfAStretch) {
    Pace pace;
    show(pace, 21, 6);
    EXPECT_FALSE(pace.is_slow());
    show(pace, 12, 1.5);
    EXPECT_FALSE(pace.is_slow()) << "for less than a stretch";
    show(pace, 12, 3);
    EXPECT_TRUE(pace.is_slow());
    show(pace, 30, 4.5);
    EXPECT_FALSE(pace.is_slow());
    Pace one;
    one.add(1.0 / 60);
    for (int i = 0; i < 2; ++i) one.add(1.2);
    EXPECT_TRUE(one.is_slow()) << "pictures that take longer than a second count";
}

TEST(Pace, BeginsAnewWithOtherSettings) {
    Pace pace;
    show(pace, 10, 3);
    pace.restart();
    EXPECT_FALSE(pace.is_slow());
    pace.add(5);  // shaders, maps
    EXPECT_FALSE(pace.is_slow());
    show(pace, 40, 3);
    EXPECT_FALSE(pace.is_slow());
}

}  // namespace
}  // namespace vesper::test::pace_test
