// From which distance obstacles of a drive are seen. SPDX-License-Identifier: MIT
#include "record/detection.h"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

namespace vesper::test::detection_test {
namespace {

using render::SeenObstacle;

/// 10 arc minutes, on 1 cd/m^2 and `veil`: 1 cd/m^2 more is a level of 12.4 without a veil, and of less with one.
SeenObstacle at(double distance, double more, double veil = 0) {
    return {.state = SeenObstacle::State::Measured,
            .distance = distance,
            .steradians = 6.646e-6,
            .luminance = 1 + more,
            .around = 1,
            .veil = veil};
}
SeenObstacle hidden(double distance) { return {.state = SeenObstacle::State::Hidden, .distance = distance}; }

std::vector<scene::Obstacle> named(std::vector<std::string> names) {
    std::vector<scene::Obstacle> obstacles;
    for (const std::string& name : names) obstacles.push_back({name, {}});
    return obstacles;
}

/// The words of a line of the table that begins with a name.
std::vector<std::string> row_of(const std::string& table, const std::string& name) {
    std::istringstream line(table.substr(table.find("\n" + name) + 1));
    std::vector<std::string> words(4);
    for (std::string& word : words) line >> word;
    return words;
}

TEST(Detection, IsTheFirstFrameWithTheLevel) {
    drive::Detections seen(named({"man", "dark", "never", "near"}), 7);
    seen.add(std::vector{hidden(99), at(90, 0), hidden(50), at(5, 1)}, 23, true);
    seen.add(std::vector{at(80, 1, 20), at(70, -0.9), hidden(40), at(4, 1)}, 23, true);
    seen.add(std::vector{at(60, 1), at(50, 0), hidden(30), at(6, 1)}, 23, true);
    seen.add({}, 23, true);  // without luminances
    const std::string table = seen.table();
    using Words = std::vector<std::string>;
    EXPECT_TRUE(table.starts_with("level 7 first at, m "));
    EXPECT_EQ(row_of(table, "man"), (Words{"man", "60.0", "80.0", "60.0"})) << "with a veil it is not seen";
    EXPECT_EQ(row_of(table, "dark"), (Words{"dark", "70.0", "70.0", "50.0"})) << "darker than what is around it";
    EXPECT_EQ(row_of(table, "never"), (Words{"never", "-", "-", "-"}));
    EXPECT_EQ(row_of(table, "near"), (Words{"near", "5.0+", "5.0+", "4.0"}));

    const apps::LinePlot plot = seen.plot();
    ASSERT_EQ(plot.lines.size(), 6u) << "two of each that was measured, the nearest first";
    EXPECT_EQ(plot.rule, 7);
    EXPECT_EQ(plot.lines[0].name, "near");
    EXPECT_EQ(plot.lines[1].name, "near, no glare");
    EXPECT_TRUE(plot.lines[1].dashed);
    const apps::PlotLine& dark = plot.lines[2];
    EXPECT_EQ(dark.points[1].x, 70);
    EXPECT_GT(dark.points[1].y, 7) << "whatever its sign";
    EXPECT_TRUE(std::isnan(dark.points[3].x)) << "breaks the line";
}

// Without scatter a level with glare would be one without it.
TEST(Detection, WithGlareIsUnknownWhereNoneIsComputed) {
    drive::Detections seen(named({"man"}), 7);
    seen.add(std::vector{at(60, 1)}, 23, false);
    EXPECT_EQ(row_of(seen.table(), "man"), (std::vector<std::string>{"man", "-", "60.0+", "60.0"}));
    EXPECT_NE(seen.table().find("--glare cie"), std::string::npos);
    ASSERT_EQ(seen.plot().lines.size(), 1u);
    EXPECT_EQ(seen.plot().lines[0].name, "man, no glare");
}

TEST(Detection, OlderEyesNeedMore) {
    EXPECT_EQ(drive::is_visible(at(10, 0.7), 23, 7), std::optional(true));
    EXPECT_EQ(drive::is_visible(at(10, 0.7), 70, 7), std::optional(false));
    EXPECT_EQ(drive::is_visible(hidden(10), 23, 7), std::nullopt);
}

}  // namespace
}  // namespace vesper::test::detection_test
