// `vesper study headlamps` as people run it: a car on a plane before a box, and another that dazzles.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/gltf_save.h"
#include "support/occluders.h"
#include "support/program.h"

namespace vesper::test {
namespace {

/// The driver's car at the origin looks along -Z, a box of 0.6 m x 1.8 m is its obstacle at z = -60, a car before it
/// shines back; all on a plane of reflectance 0.1.
scene::Scene dark_road() {
    OccluderScene made;
    made.box({0, 0.9f, 0}, {0.3f, 0.9f, 0.3f});
    made.plate({0, 0, 0}, {300, 0, 0}, {0, 0, -300});
    scene::Scene scene = made.scene();
    scene.materials.front().base_colour = {0.1f, 0.1f, 0.1f, 1};
    scene.nodes[0].name = "person";
    scene.nodes[0].translation = {0.6, 0, -60};
    scene.cameras.push_back({.name = "driver", .vertical_fov = 0.3f});
    scene.lamps.push_back({.name = "lobe",
                           .kind = scene::Lamp::Kind::Spot,
                           .intensity = 10'000,
                           .inner_cone = 0.05f,
                           .outer_cone = 0.3f});
    const auto add = [&](const char* name, uint32_t parent, glm::dvec3 place) {
        scene::Node& node = scene.nodes.emplace_back();
        node.name = name, node.parent = parent, node.translation = place;
        return uint32_t(scene.nodes.size() - 1);
    };
    const uint32_t car = add("car", scene::kNone, {0, 0, 0}), other = add("other", scene::kNone, {-3, 0, -80});
    for (const double side : {-0.6, 0.6}) scene.nodes[add("headlamp", car, {side, 0.65, -2})].lamp = 0;
    scene.nodes[add("driver", car, {-0.4, 1.2, 0})].camera = 0;
    scene.nodes[other].rotation = glm::angleAxis(glm::radians(180.0f), glm::vec3(0, 1, 0));
    scene.nodes[add("headlamp", other, {0, 0.65, -2})].lamp = 0;
    const uint32_t wall = add("wall", scene::kNone, {0, 0, -30});
    scene.nodes[wall].mesh = scene.nodes[0].mesh, scene.nodes[wall].scale = {10, 2, 1};
    scene.ambient_illuminance = 0.05f;
    return scene;
}

class StudyHeadlamps : public ProgramTest {
protected:
    using Row = std::map<std::string, std::string>;

    void SetUp() override {
        scene::save_gltf(dark_road(), "dark road", folder / "road.gltf");
        beam("high.csv", 40'000, 2);
        beam("low.csv", 8'000, -0.6);
    }
    /// A beam of so many cd below an angle, degrees, and of 10 cd above it, 10 degrees to all sides.
    void beam(const std::string& name, double candela, double cut) {
        std::ofstream out(folder / name);
        out << "A,-10,10\n";
        for (const double v : {-10.0, cut - 0.05, cut + 0.05, 10.0})
            out << v << "," << (v < cut ? candela : 10) << "," << (v < cut ? candela : 10) << "\n";
    }
    int study(const std::string& arguments) {
        return run(
            "study headlamps road.gltf --obstacle person --size 320x200 --indirect off --cache off "
            "-o out " +
            arguments);
    }
    std::vector<Row> rows(const std::string& name) {
        std::istringstream in(read_text(folder / name));
        std::vector<std::string> columns;
        std::vector<Row> found;
        for (std::string line; std::getline(in, line);) {
            std::istringstream cells(line);
            std::vector<std::string> values;
            for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
            if (columns.empty()) {
                columns = values;
                continue;
            }
            values.resize(columns.size());
            for (size_t i = 0; i < columns.size(); ++i)
                (i ? found.back() : found.emplace_back())[columns[i]] = values[i];
        }
        return found;
    }
    double level(const std::vector<Row>& rows, const std::string& beam, const std::string& oncoming, double distance) {
        for (Row row : rows)
            if (row["beam"] == beam && row["oncoming"] == oncoming && std::stod(row["distance"]) == distance)
                return std::stod(row["vl"]);
        ADD_FAILURE() << beam << oncoming << distance;
        return 0;
    }
};

TEST_F(StudyHeadlamps, BrighterBeamsSeeFartherAndOncomingLampsLess) {
    ASSERT_EQ(study("--beam scene --beam low.csv --beam high.csv --oncoming other --without wall --ages 60 --from 60 "
                    "--to 20 --step 40 --picture-at 20"),
              0)
        << said;
    const std::vector<Row> all = rows("out/headlamps.csv");
    ASSERT_EQ(all.size(), 3u * 2 * 2);
    for (Row row : all) {
        EXPECT_EQ(row["state"], "measured") << row["beam"] << row["distance"];
        EXPECT_EQ(row["age"], "60");
        // From the eye at 1.2 m, the middle of the box 1 m to the right and 0.3 m lower.
        EXPECT_NEAR(std::stod(row["eye_distance"]), std::hypot(std::stod(row["distance"]), 1, 0.3), 0.002);
    }
    // Two lamps of 10 000 cd a second apart in the width of a lane: E = 2 I / d^2 within their cones of 2.9 degrees.
    for (Row row : all)
        if (row["beam"] == "as in the scene" && row["oncoming"] == "off" && row["distance"] == "60") {
            EXPECT_NEAR(std::stod(row["luminance"]) * M_PI / 0.1, 2 * 10'000 / (57.7 * 57.7) + 0.05, 0.3);
        }
    for (const double distance : {60.0, 20.0}) {
        EXPECT_GT(level(all, "high", "off", distance), level(all, "high", "on", distance));
        EXPECT_GT(level(all, "high", "off", distance), level(all, "low", "off", distance));
    }
    const std::vector<Row> seen = rows("out/headlamps-seen.csv");
    ASSERT_EQ(seen.size(), 6u);
    const std::string page = read_text(folder / "out/headlamps.html");
    for (const char* part : {"1.00 m to the right", "2 headlamps", "levels-60.png", "beam-3-on.png", "beam-1-road.png"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    for (const char* file : {"levels-60.png", "beam-1-off.png", "beam-2-on.png", "beam-3-road.png"})
        EXPECT_TRUE(exists(std::string("out/") + file)) << file;
    EXPECT_NE(printed.find("high, oncoming lamps off, 60 years: seen beyond 60 m\n"), std::string::npos) << printed;
}

// What stands in the way, and is not left out, hides the obstacle.
TEST_F(StudyHeadlamps, SaysWhereNothingCanBeMeasured) {
    ASSERT_EQ(study("--beam high.csv --ages 25 --from 50 --to 25 --step 25 --place-obstacle 0,0,-60"), 0) << said;
    for (Row row : rows("out/headlamps.csv")) EXPECT_EQ(row["oncoming"], "none");
    EXPECT_NE(printed.find("high, oncoming lamps none, 25 years: seen beyond 25 m"), std::string::npos) << printed;
    EXPECT_NE(read_text(folder / "out/headlamps-seen.csv").find("50 m: "), std::string::npos);
    ASSERT_EQ(study("--beam high.csv --ages 25 --from 20 --to 20 --place-obstacle 60,0,-60"), 0) << said;
    EXPECT_NE(read_text(folder / "out/headlamps-seen.csv").find("not measured,,20 m: "), std::string::npos);
    EXPECT_NE(printed.find("high, oncoming lamps none, 25 years: not measured\n"), std::string::npos) << printed;
    EXPECT_EQ(rows("out/headlamps.csv").front()["vl"], "");
}

TEST_F(StudyHeadlamps, RefusesInOneLine) {
    const std::string start = "study headlamps road.gltf --obstacle person -o out ";
    expect_refused(start, {"--beam"});
    expect_refused(start + "--beam none.csv", {"none.csv"});
    expect_refused(start + "--beam low.csv --beam ./low.csv", {"--beam ./low.csv: a second beam"});
    expect_refused(start + "--beam low.csv --oncoming nobody", {"--oncoming nobody"});
    expect_refused(start + "--beam low.csv --from 10 --to 20", {"--from is less than --to"});
    expect_refused(start + "--beam low.csv --from 1000 --to 1 --step 0.1", {"more than 1000"});
    expect_refused(start + "--beam low.csv --age 30", {"--age"});
    expect_refused(start + "--beam low.csv --place-obstacle 1,2", {"--place-obstacle"});
    expect_refused(start + "--beam low.csv --operator ldr", {"ldr"});
    expect_refused(start + "--beam low.csv --scale 0.5", {"--scale"});
    expect_refused("study headlamps road.gltf --obstacle car --beam low.csv -o out", {"--obstacle car"});
    EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace vesper::test
