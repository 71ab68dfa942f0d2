// Logs that are read: the eyes that were written, and none that no eye is. SPDX-License-Identifier: MIT
#include "tone_log.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <gtest/gtest.h>

#include "base/error.h"
#include "print.h"
#include "support/csv_cells.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

/// An eye by day with a curve of four steps, and, with a lag, that of the operator pattanaik.
shared::EyeState sound_eye(bool lags) {
    shared::EyeState eye{};
    eye.adaptation = 250.38f, eye.seconds = 3.5f, eye.seconds_lost = 1e-8f, eye.pupil = 4.13f;
    eye.cones = {0.934f, 0.741f, 0.741f}, eye.rods = {0.9997f, 1.4765f, 3.4452f};
    eye.chroma = {0.1f, -0.2f, 0.3f};
    eye.steps = 4, eye.ln_low = -9.21f, eye.steps_per_ln = 8.69f;
    for (int i = 0; i <= 4; ++i) eye.node[i] = -2.15f + float(i);
    if (lags) eye.pattanaik = {40.7f, 98.2f, 0.99f, 0.19f};
    return eye;
}

std::string line_of(const shared::EyeState& eye) {
    return apps::log_line(7, {1.25, 0.25f, "irawan", eye}, {}, render::Operator::Irawan, {}, {});
}

std::string joined(const std::vector<std::string>& cells) {
    std::string line = cells[0];
    for (size_t i = 1; i < cells.size(); ++i) line += "," + cells[i];
    return line;
}

class ToneLog : public testing::Test {
protected:
    TempFolder folder;
    const std::vector<std::string> names = cells_of(apps::log_heading());

    size_t column(const std::string& name) const { return size_t(std::ranges::find(names, name) - names.begin()); }
    std::string message_of(const std::string& text) {
        folder.write("eye.csv", text);
        try {
            apps::read_log(folder / "eye.csv");
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
    /// Of a log without sums with another text in one column of its second row.
    std::string message_of(const std::string& name, const std::string& cell, bool lags = false) {
        const std::string line = line_of(sound_eye(lags));
        std::vector<std::string> cells = cells_of(line);
        cells.at(column(name)) = cell;
        return message_of(apps::log_heading() + "\n" + line + "\n" + joined(cells) + "\n");
    }
};

TEST_F(ToneLog, GivesBackTheEyeThatWasWritten) {
    for (const bool lags : {false, true}) {
        const shared::EyeState eye = sound_eye(lags);
        for (const bool summed : {false, true}) {
            const std::string heading = summed ? apps::summed_heading(apps::log_heading()) : apps::log_heading();
            const std::string line = summed ? apps::summed_line(line_of(eye)) : line_of(eye);
            ASSERT_EQ(message_of(heading + "\n" + line + "\n"), "");
            const std::vector<apps::LoggedFrame> frames = apps::read_log(folder / "eye.csv");
            ASSERT_EQ(frames.size(), 1u);
            EXPECT_EQ(apps::named_state(frames[0].eye), apps::named_state(eye));
            EXPECT_TRUE(std::equal(std::begin(eye.node), std::end(eye.node), std::begin(frames[0].eye.node)));
            EXPECT_EQ(frames[0].seconds, 1.25);
        }
    }
}

TEST_F(ToneLog, RefusesEyesThatNoEyeIs) {
    struct Wrong {
        const char *name, *cell, *reason;
        bool lags = false;
    };
    constexpr Wrong kWrong[]{
        {"step", "-0.1", "no time"},
        {"adaptation", "-1", "1e+06 cd/m^2"},
        {"adaptation", "0", "0 as the values"},  // an eye that has seen nothing remembers nothing
        {"adaptation", "1e7", "1e+06 cd/m^2"},
        {"adaptation", "1e-7", "1e+06 cd/m^2"},
        {"eye_seconds", "-1", " s"},
        {"eye_seconds", "1e13", " s"},
        {"eye_seconds_lost", "1", " s"},
        {"eye_seconds_lost", "-0.01", " s"},
        {"pupil_at_rest", "0", "from 1.9 to 7.9 mm"},
        {"pupil_at_rest", "80", "from 1.9 to 7.9 mm"},
        {"pupil_at_rest", "-4.9", "from 1.9 to 7.9 mm"},
        {"cone_pigment", "0", "to 1"},
        {"cone_pigment", "-1", "to 1"},
        {"cone_pigment", "1.01", "to 1"},
        {"cone_pigment", "1e-30", "to 1"},
        {"rod_pigment", "0", "to 1"},
        {"rod_pigment", "-0.5", "to 1"},
        {"rod_pigment", "2", "to 1"},
        {"cone_fast", "38", "from -12 to 12"},
        {"cone_slow", "-38", "from -12 to 12"},
        {"rod_fast", "1e9", "from -12 to 12"},
        {"rod_slow", "-1e9", "from -12 to 12"},
        {"chroma_long", "80", "from -40 to 40"},
        {"chroma_middle", "-80", "from -40 to 40"},
        {"chroma_short", "1e30", "from -40 to 40"},
        {"steps", "-4", "from 0 to 256"},
        {"steps", "257", "from 0 to 256"},
        {"steps", "3.5", "no whole number"},
        {"steps", "3", "is not 0"},
        {"steps", "5", "less than"},
        {"steps", "0", "is not 0"},
        {"ln_low", "-90", "from -20 to 21"},
        {"ln_low", "90", "from -20 to 21"},
        {"steps_per_ln", "0", "from 0.001"},
        {"steps_per_ln", "-8", "from 0.001"},
        {"steps_per_ln", "1e9", "from 0.001"},
        {"node0", "88", "from -20 to 20"},
        {"node2", "-88", "from -20 to 20"},
        {"node3", "-1.5", "less than"},
        {"node9", "1", "is not 0"},
        {"node256", "-0.1", "is not 0"},
        {"lagging_rods", "1", "is not 0"},
        {"lagging_cone_pigment", "1", "is not 0"},
        {"lagging_cones", "-1", "1e+06 cd/m^2", true},
        {"lagging_cones", "0", "is not 0", true},
        {"lagging_rods", "0", "scotopic cd/m^2", true},
        {"lagging_rods", "1e9", "scotopic cd/m^2", true},
        {"lagging_cone_pigment", "0", "from 0.6 to 1", true},
        {"lagging_rod_pigment", "-1", "to 1", true},
        {"lagging_rod_pigment", "7", "to 1", true},
        {"cone_pigment", "nan", "a number is expected"},
        {"node4", "inf", "a number is expected"},
        {"rod_slow", "", "a number is expected"},
    };
    for (const Wrong& wrong : kWrong) {
        const std::string said = message_of(wrong.name, wrong.cell, wrong.lags);
        EXPECT_NE(said.find("eye.csv: line 3: "), said.npos) << wrong.name << " " << wrong.cell << ": " << said;
        EXPECT_NE(said.find(wrong.reason), said.npos) << wrong.name << " " << wrong.cell << ": " << said;
        EXPECT_NE(said.find("column "), said.npos) << said;
    }
    const std::string said = message_of("cone_pigment", "-1");
    EXPECT_NE(said.find("eye.csv: line 3: column 9 (cone_pigment): -1 is not from "), said.npos) << said;
}

TEST_F(ToneLog, RefusesRowsThatWereChanged) {
    const std::string heading = apps::summed_heading(apps::log_heading()),
                      row = apps::summed_line(line_of(sound_eye(true)));
    const std::vector<std::string> cells = cells_of(row);
    ASSERT_EQ(cells.size(), names.size() + 1);
    ASSERT_EQ(message_of(heading + "\n" + row + "\n" + row), "");
    // Values that an eye might have, and that are not used, among them.
    for (const auto& [name, cell] : {std::pair("cone_pigment", "0.5"), std::pair("node2", "-0.1"),
                                     std::pair("seconds", "1.5"), std::pair("maximum", "1")}) {
        std::vector<std::string> changed = cells;
        changed.at(column(name)) = cell;
        const std::string said = message_of(heading + "\n" + row + "\n" + joined(changed) + "\n");
        EXPECT_NE(said.find(apps::format("eye.csv: line 3: column %zu (sum)", names.size() + 1)), said.npos) << said;
    }
    std::vector<std::string> changed = cells;
    changed.back() = "";
    EXPECT_NE(message_of(heading + "\n" + joined(changed)), "");
    EXPECT_NE(message_of(heading + "\nx"), "");
    EXPECT_NE(message_of(heading + "\n,"), "");
    changed.pop_back();
    EXPECT_NE(message_of(heading + "\n" + joined(changed)), "");
}

TEST_F(ToneLog, JudgesSharedFiles) {
    const std::string shared = shared_data("hostile-t3/eye-").string();
    if (!is_here(shared + "good.csv")) GTEST_SKIP() << "no shared data";
    EXPECT_EQ(apps::read_log(shared + "good.csv").size(), 1u);
    EXPECT_THROW(apps::read_log(shared + "blind.csv"), Error);
    EXPECT_THROW(apps::read_log(shared + "nan.csv"), Error);
}

}  // namespace
}  // namespace vesper::test
