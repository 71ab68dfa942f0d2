// Parts of a way where an obstacle is seen, against lines drawn by hand. SPDX-License-Identifier: MIT
#include "sightings.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using commands::LevelAt, commands::words_of;

constexpr std::nullopt_t kUnknown = std::nullopt;

std::string seen(const std::vector<LevelAt>& way) { return words_of(way, 7); }

TEST(Sightings, BeginWhereTheLineReachesTheLevel) {
    EXPECT_EQ(seen({{100, 1}, {80, 5}, {60, 9}, {40, 30}}), "from 70 m");
    EXPECT_EQ(seen({{100, -1}, {80, -5}, {60, -9}, {40, -30}}), "from 70 m") << "darker than its surroundings";
    EXPECT_EQ(seen({{100, 8}, {50, 20}}), "beyond 100 m");
    EXPECT_EQ(seen({{100, 1}, {50, 6.9}}), "never");
    EXPECT_EQ(seen({{100, 0}, {50, 7}}), "never") << "no more than the last distance";
    EXPECT_EQ(seen({{50, 7}}), "beyond 50 m");
    EXPECT_EQ(seen({{1000, 7.1}, {500.04, 7}, {400, 0}}), "beyond 1000 to 500 m");
    EXPECT_EQ(seen({{100, 7}, {50, 7}}), "beyond 100 m");
}

// From dark to bright it is not seen in between: at +7 and at -7 of the line from -21 to 21, a third and two thirds of
// the way.
TEST(Sightings, EndWhereTheContrastIsLost) {
    EXPECT_EQ(seen({{90, -21}, {60, 21}, {30, 28}}), "beyond 90 to 80 m, from 70 m");
    EXPECT_EQ(seen({{90, 0}, {80, -14}, {60, 14}, {50, 0}}), "85 to 75 m, 65 to 55 m");
    EXPECT_EQ(seen({{90, 14}, {70, 0}, {60, 14}, {50, 14}}), "beyond 90 to 80 m, from 65 m");
    EXPECT_EQ(seen({{90, 7}, {80, 0}, {70, 7}, {60, 14}}), "beyond 90 to 90 m, from 70 m");
}

// What could not be measured is neither seen nor unseen.
TEST(Sightings, SayWhatIsNotMeasured) {
    EXPECT_EQ(seen({{90, 10}, {80, 10}, {70, kUnknown}, {60, 10}, {50, 10}}),
              "beyond 90 to 80 m at least, beyond 60 m");
    EXPECT_EQ(seen({{90, kUnknown}, {80, 10}, {70, 10}, {60, kUnknown}}), "beyond 80 to 70 m at least");
    EXPECT_EQ(seen({{90, kUnknown}, {80, 0}, {70, 14}}), "from 75 m");
    EXPECT_EQ(seen({{90, kUnknown}, {80, 6}}), "never where it is measured");
    EXPECT_EQ(seen({{90, kUnknown}, {80, kUnknown}}), commands::kNotMeasured);
    EXPECT_EQ(seen({}), commands::kNotMeasured);
}

TEST(Sightings, TheLineOfTheirPlotGoesDownBetweenTheSigns) {
    const std::vector<LevelAt> way{{90, -10}, {80, 10}, {70, kUnknown}, {60, 5}};
    const auto line = commands::level_line(way, 0.1);
    double least = 100;
    for (const glm::dvec2& point : line) {
        if (point.x == 70) {
            EXPECT_TRUE(std::isnan(point.y));
        }
        if (point.x > 80) {
            EXPECT_NEAR(point.y, std::max(std::abs(2 * (85 - point.x)), 0.1), 1e-9);
            least = std::min(least, point.y);
        }
    }
    EXPECT_EQ(least, 0.1);
    EXPECT_EQ(line.front(), glm::dvec2(90, 10));
    EXPECT_EQ(line.back(), glm::dvec2(60, 5));
}

}  // namespace
}  // namespace vesper::test
