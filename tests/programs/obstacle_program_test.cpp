// Obstacles from the command line. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <map>
#include <sstream>

#include "support/csv_cells.h"
#include "support/luminous_card.h"
#include "vision/visibility.h"

namespace vesper::test::obstacle_program_test {
namespace {

/// Rows of a CSV file: by the name of the column, in order.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const std::vector<std::string> names = cells_of(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(lines, line)) {
        const std::vector<std::string> cells = cells_of(line);
        EXPECT_EQ(cells.size(), names.size());
        auto& row = rows.emplace_back();
        for (size_t i = 0; i < std::min(names.size(), cells.size()); ++i) row[names[i]] = cells[i];
    }
    return rows;
}

class ObstacleProgram : public ProgramTest {
protected:
    explicit ObstacleProgram(std::string program = VESPER_PROGRAM) : ProgramTest(std::move(program)) {}
    void SetUp() override { folder.write("a.gltf", luminous_card(15)); }
    const std::string render = "render a.gltf --size 96x60 --shadows off --indirect off ";
};

TEST_F(ObstacleProgram, RenderPrintsAndLogsThem) {
    ASSERT_EQ(run(render + "--obstacle 'c?rd' --frames 2 --log l.csv -o a%d.png --eye-out e.csv"), 0) << said;
    EXPECT_TRUE(printed.starts_with("obstacle card, 15.0 m: ")) << printed;
    EXPECT_NE(printed.find(" arc minutes, 3 cd/m^2 on 2 cd/m^2, visibility level without glare "), std::string::npos)
        << printed;
    const auto rows = rows_of(read_text(folder / "l.csv"));
    ASSERT_EQ(rows.size(), 2u);
    for (auto row : rows) {
        EXPECT_NEAR(std::stod(row["distance:card"]), 15, 0.01);
        EXPECT_NEAR(std::stod(row["target:card"]), 3, 1e-4);
        EXPECT_NEAR(std::stod(row["around:card"]), 2, 1e-4);
        EXPECT_EQ(row["target_veil:card"], "0");
        EXPECT_GT(std::stod(row["size:card"]), 60);
        const double want = vision::visibility_level(3, 2, {.size = 60});
        EXPECT_NEAR(std::stod(row["visibility:card"]), want, 1e-3 * want);
        EXPECT_EQ(row["visibility:card"], row["visibility_without_veil:card"]);
    }
    // Logs with such columns are read as others are.
    ASSERT_EQ(run(render + "--replay l.csv --start 0.02 -o b.png"), 0) << said;
    EXPECT_EQ(read_text(folder / "a1.png"), read_text(folder / "b.png"));
    for (const char* log : {"l.csv", "e.csv"}) ASSERT_EQ(run(render + "--eye-in " + log + " -o c.png"), 0) << said;
    // Older eyes see less.
    ASSERT_EQ(run(render + "--obstacle card --age 70 --log old.csv"), 0) << said;
    EXPECT_LT(std::stod(rows_of(read_text(folder / "old.csv"))[0]["visibility:card"]),
              std::stod(rows[0].at("visibility:card")));
}

TEST_F(ObstacleProgram, NamesStayInTheirLine) {
    std::string text = luminous_card(15);
    const std::string name = "\"card\"";
    text.replace(text.find(name), name.size(), "\"ca\\nrd\"");
    folder.write("a.gltf", text);
    ASSERT_EQ(run(render + "--obstacle 'ca*'"), 0) << said;
    EXPECT_TRUE(printed.starts_with("obstacle ca?rd, 15.0 m: ")) << printed;
}

TEST_F(ObstacleProgram, WhatIsNotMeasuredHasNoNumber) {
    folder.write("a.gltf", luminous_card(500));
    ASSERT_EQ(run(render + "--obstacle card --log l.csv"), 0) << said;
    EXPECT_EQ(printed, "obstacle card, 500.0 m: hidden\n");
    auto row = rows_of(read_text(folder / "l.csv")).at(0);
    EXPECT_EQ(row["distance:card"], "500");
    for (const char* column : {"size", "target", "around", "target_veil", "visibility", "visibility_without_veil"})
        EXPECT_EQ(row.at(std::string(column) + ":card"), "") << column;
}

class ObstacleDrive : public ObstacleProgram {
protected:
    ObstacleDrive() : ObstacleProgram(VESPER_DRIVE) {}
    const std::string drive =
        "a.gltf --headless --autopilot --fps 4 --size 96x60 --shadows off --indirect off --obstacle card ";
};

// A car begins to move 75 m before the card, which is then 2 px wide and 3 px high, and comes nearer.
TEST_F(ObstacleDrive, SaysFromWhereTheyAreSeen) {
    folder.write("a.gltf", luminous_card(75));
    ASSERT_EQ(run(drive + "--seconds 8 --log l.csv --detection-plot p.png"), 0) << said;
    const auto rows = rows_of(read_text(folder / "l.csv"));
    ASSERT_EQ(rows.size(), 33u);
    EXPECT_NEAR(std::stod(rows[0].at("distance:card")), 75, 0.3) << "the eye is not quite where the camera is";
    EXPECT_LT(std::stod(rows.back().at("distance:card")), 55);
    EXPECT_EQ(rows[0].at("visibility:card"), "") << "too few pixels";
    const auto first = std::find_if(rows.begin(), rows.end(), [](const auto& row) {
        return !row.at("visibility:card").empty() && std::stod(row.at("visibility:card")) >= 7;
    });
    ASSERT_NE(first, rows.end());
    char distance[16];
    std::snprintf(distance, sizeof distance, "%.1f", std::stod(first->at("distance:card")));
    EXPECT_NE(printed.find("level 7 first at, m"), std::string::npos) << printed;
    EXPECT_NE(printed.find(std::string("  ") + distance + "  "), std::string::npos) << printed << distance;
    EXPECT_TRUE(read_text(folder / "p.png").starts_with("\x89PNG"));
    // A level that it never has; and the table alone is reason enough to drive.
    ASSERT_EQ(run(drive + "--seconds 0.5 --visible-from 900"), 0) << said;
    EXPECT_NE(printed.find("level 900 first at, m"), std::string::npos) << printed;
    EXPECT_EQ(printed.find("\n+:"), std::string::npos);
}

TEST_F(ObstacleDrive, WithoutLuminancesCellsAreEmpty) {
    folder.write("d.json", R"({"vesper_drive":1,"scene":"a.gltf","events":[{"frame":true},
        {"set":{"operator":"ldr"}},{"step":{}},{"frame":true}]})");
    const std::string replay =
        "--headless --replay d.json --size 96x60 --shadows off --indirect off --obstacle card --log l.csv ";
    ASSERT_EQ(run(replay), 0) << said;
    const auto rows = rows_of(read_text(folder / "l.csv"));
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_NE(rows[0].at("visibility:card"), "");
    for (const char* column : {"distance:card", "visibility:card", "visibility_without_veil:card"})
        EXPECT_EQ(rows[1].at(column), "");
    EXPECT_NE(printed.find("15.2+"), std::string::npos) << "seen in the first frame: " << printed;
    EXPECT_NE(printed.find("\n+:"), std::string::npos);
    expect_refused(replay + "--operator ldr", {"--obstacle", "ldr"});
}

TEST_F(ObstacleDrive, WhatIsNotSeenCanBeHatched) {
    const auto film = [&](const std::string& options, const std::string& name) {
        EXPECT_EQ(run(drive + "--seconds 0 --video " + name + "%d.png " + options), 0) << said;
        return read_text(folder / (name + "0.png"));
    };
    const std::string plain = film("", "a");
    EXPECT_EQ(film("--hatch-unseen", "b"), plain) << "it is seen";
    EXPECT_EQ(film("--visible-from 900", "c"), plain) << "not without the option";
    EXPECT_NE(film("--visible-from 900 --hatch-unseen", "d"), plain);
    EXPECT_NE(film("--visible-from 900 --hatch-unseen --scale 0.5", "e"), film("--scale 0.5", "f"));
}

TEST_F(ObstacleDrive, RefusesWhatHasNoMeaning) {
    expect_refused(drive + "--obstacle dog", {"--obstacle dog"});
    expect_refused(drive + "--detection-plot p.jpg", {"--detection-plot p.jpg", ".png"});
    expect_refused(drive + "--visible-from 0", {"--visible-from"});
    expect_refused("a.gltf --headless --log l.csv --visible-from 3", {"--visible-from", "--obstacle"});
    expect_refused("a.gltf --headless --log l.csv --detection-plot p.png", {"--detection-plot", "--obstacle"});
    expect_refused("a.gltf --headless --log l.csv --hatch-unseen", {"--hatch-unseen", "--obstacle"});
    expect_refused("a.gltf --headless --log l.csv --obstacle card --channels c.json", {"--obstacle", "--channels"});
    EXPECT_FALSE(exists("l.csv") || exists("p.png"));
}

TEST_F(ObstacleProgram, RefusesWhatIsNotThere) {
    expect_refused(render + "-o a.png --obstacle card --obstacle 'cat*'", {"--obstacle cat*", "no node"});
    expect_refused(render + "-o a.png --obstacle eye", {"--obstacle eye"});
    expect_refused(render + "-o a.png --obstacle card --operator ldr", {"--obstacle", "ldr"});
    folder.write("other.csv", "frame,seconds\n0,0\n");
    expect_refused(render + "-o a.png --replay other.csv", {"columns"});
    EXPECT_FALSE(exists("a.png"));
}

}  // namespace
}  // namespace vesper::test::obstacle_program_test
