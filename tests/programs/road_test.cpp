// `vesper road` as people run it; --render needs a device. SPDX-License-Identifier: MIT
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/hdr_image.h"
#include "places.h"
#include "scene/gltf_save.h"
#include "support/occluders.h"

namespace {

namespace fs = std::filesystem;

class Road : public testing::Test {
protected:
    fs::path folder = fs::temp_directory_path() /
                      ("vesper-road-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
                       "-" + std::to_string(::getpid()));
    void SetUp() override {
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    std::string text_of(const std::string& file) const {
        std::ifstream in(folder / file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    int run(const std::string& arguments,
            const std::string& layout = VESPER_SOURCE_DIR "/data/road/worked-example.json") {
        const std::string command = "cd '" + folder.string() + "' && '" VESPER_PROGRAM "' road '" + layout + "' " +
                                    arguments + " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
};

TEST_F(Road, PrintsFiguresAndWritesPoints) {
    ASSERT_EQ(run("--csv points.csv --json road.json --grid"), 0) << text_of("err.txt");
    const std::string out = text_of("out.txt"), csv = text_of("points.csv"), json = text_of("road.json");
    for (const char* part :
         {"1.164   >= 1     ok", "0.544   >= 0.6   missed", "reached (EN 13201-2:2015, dry): M5", "observer of lane 2"})
        EXPECT_NE(out.find(part), std::string::npos) << part << out;
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 62);
    EXPECT_NE(csv.find("\n10.5000,0.5833,12.2136,2.19201,1.91229\n"), std::string::npos) << csv.substr(0, 300);
    EXPECT_NE(json.find("\"class_reached\": \"M5\""), std::string::npos);
    ASSERT_EQ(run("--r-table R2 --class M4"), 0);
    EXPECT_NE(text_of("out.txt").find("1.139   >= 0.75  ok"), std::string::npos) << text_of("out.txt");
    ASSERT_EQ(run("--r-table W3 --class M3 --json wet.json"), 0);
    const std::string wet = text_of("out.txt");
    EXPECT_NE(wet.find("   >= 0.15 "), std::string::npos) << wet;
    EXPECT_EQ(wet.find(">= 1 "), std::string::npos) << wet;
    EXPECT_EQ(wet.find("class reached"), std::string::npos) << wet;
    EXPECT_NE(text_of("wet.json").find("\"class_reached\": null"), std::string::npos);
}

// The designed road can be seen: as a scene of its luminaires with their openings, and a camera for each observer.
TEST_F(Road, WritesItsScene) {
    ASSERT_EQ(run("--scene road.gltf"), 0) << text_of("err.txt");
    const auto json = nlohmann::json::parse(text_of("road.gltf"));
    std::vector<std::string> cameras;
    size_t lamps = 0;
    for (const auto& node : json["nodes"]) {
        if (node.contains("camera")) cameras.push_back(node["name"]);
        lamps += node.contains("extensions");
    }
    EXPECT_EQ(cameras, (std::vector<std::string>{"observer lane 1", "observer lane 2"}));
    EXPECT_GT(lamps, 5u);
    EXPECT_GT(json["extras"]["vesper"]["openings"].size(), 0u);
    EXPECT_EQ(run("--scene road.obj"), 2);
    EXPECT_EQ(text_of("err.txt"), "vesper: --scene road.obj: a .gltf or .glb file is expected\n");
}

// A tree hides luminaires; the figures of the standard stand beside, and are all there is without occlusion.
TEST_F(Road, CountsOccluders) {
    vesper::test::OccluderScene tree;
    tree.box({-8, 4.25f, -20}, {3, 3.75f, 4});  // over the left lane, from 0.5 m up
    vesper::scene::save_gltf(tree.scene(), "tree", folder / "tree.gltf");
    ASSERT_EQ(run("--json plain.json --csv plain.csv"), 0) << text_of("err.txt");
    ASSERT_EQ(run("--occluders tree.gltf --json on.json --csv on.csv"), 0) << text_of("err.txt");
    const std::string out = text_of("out.txt");
    EXPECT_NE(out.find("without occluders (EN 13201-3)"), std::string::npos) << out;
    EXPECT_NE(out.find("  1.164 ok\n"), std::string::npos) << out;
    EXPECT_NE(out.find("dry): M5; with occluders"), std::string::npos) << out;
    const auto plain = nlohmann::json::parse(text_of("plain.json")), on = nlohmann::json::parse(text_of("on.json"));
    const size_t pairs = on["occlusion"]["pairs"], hidden = on["occlusion"]["hidden_pairs"];
    EXPECT_GT(hidden, 0u);
    EXPECT_LT(hidden, pairs);
    const std::string stated =
        "tree.gltf: " + std::to_string(hidden) + " of " + std::to_string(pairs) + " luminaire-point pairs are hidden\n";
    EXPECT_NE(out.find(stated), std::string::npos) << out;
    for (const char* figure : {"average_luminance_cd_m2", "threshold_increment_percent", "average_illuminance_lx"})
        EXPECT_EQ(on["occlusion"]["en_13201_3"][figure], plain[figure]);
    EXPECT_LT(on["average_illuminance_lx"], plain["average_illuminance_lx"]);
    EXPECT_NE(text_of("on.csv").find("less what tree.gltf hides\n"), std::string::npos);
    ASSERT_EQ(run("--occluders tree.gltf --occlusion off --json off.json --csv off.csv"), 0) << text_of("err.txt");
    EXPECT_EQ(text_of("off.json"), text_of("plain.json"));
    EXPECT_EQ(text_of("off.csv"), text_of("plain.csv"));
    EXPECT_NE(text_of("out.txt").find("tree.gltf: not counted, as in EN 13201-3"), std::string::npos);
    EXPECT_EQ(run("--occlusion on"), 2);
    EXPECT_NE(text_of("err.txt").find("neither the layout nor --occluders"), std::string::npos);
    EXPECT_EQ(run("--occluders tree.gltf --render x.png"), 2);
    EXPECT_NE(text_of("err.txt").find("--render has no occluders"), std::string::npos);
}

// docs/small-targets.md states these figures; tests/roads/small_targets_test.cpp holds them against a reference.
TEST_F(Road, SaysWhetherSmallTargetsAreSeen) {
    ASSERT_EQ(run("--json plain.json --csv plain.csv"), 0) << text_of("err.txt");
    EXPECT_EQ(text_of("out.txt").find("STV"), std::string::npos);
    ASSERT_EQ(run("--stv --stv-map map.png --grid --json a.json --csv a.csv"), 0) << text_of("err.txt");
    const std::string out = text_of("out.txt"), csv = text_of("a.csv");
    EXPECT_NE(out.find("STV               2.23   VL from -6.5 to 6.3, 28 of 60 targets darker"), std::string::npos)
        << out;
    EXPECT_NE(out.find("   0.583   -4.67   -2.08"), std::string::npos) << out;
    const auto json = nlohmann::json::parse(text_of("a.json"));
    const auto& found = json["small_targets"];
    EXPECT_NEAR(found["stv"], 2.23, 0.005);
    ASSERT_EQ(found["targets"].size(), 60u);
    EXPECT_EQ(found["reflectance"], 0.5);
    EXPECT_NEAR(found["targets"][0]["visibility_level"], -4.67, 0.005);
    EXPECT_EQ(found["targets"][9]["x_m"], json["points"][9]["x_m"]);
    EXPECT_NE(csv.find(",L_lane2_cd_m2,E_v_lx,Lt_cd_m2,Lb_cd_m2,Lv_cd_m2,VL\n1.5000,"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder / "map.png"));
    auto without = json;
    without.erase("small_targets");
    EXPECT_EQ(without, nlohmann::json::parse(text_of("plain.json")));

    ASSERT_EQ(run("--stv --target-reflectance 0.2"), 0);
    EXPECT_NE(text_of("out.txt").find("58 of 60 targets darker"), std::string::npos) << text_of("out.txt");

    vesper::test::OccluderScene tree;
    tree.box({-8, 4.25f, -20}, {3, 3.75f, 4});
    vesper::scene::save_gltf(tree.scene(), "tree", folder / "tree.gltf");
    ASSERT_EQ(run("--occluders tree.gltf --stv --json b.json"), 0) << text_of("err.txt");
    EXPECT_NE(text_of("out.txt").find("  unoccluded        2.23   VL from -6.5"), std::string::npos);
    const auto shaded = nlohmann::json::parse(text_of("b.json"))["small_targets"];
    EXPECT_EQ(shaded["stv_without_occluders"], found["stv"]);
    EXPECT_NE(shaded["stv"], found["stv"]);
}

/// Largest differences of points and of averages between calculation and pictures, %, of what `--json a.json` wrote.
struct Differences {
    double point = 0, average = 0, every_average = 0;
    size_t observers = 0;
};
Differences differences_in(const std::string& text) {
    const auto json = nlohmann::json::parse(text);
    Differences found;
    for (const auto& observer : json["observers"]) {
        const auto largest = [&](double& most, const char* which, const char* key) {
            most = std::max(most, std::abs(observer[which][key].get<double>()));
        };
        largest(found.point, "rendered", "largest_difference_percent");
        largest(found.average, "rendered", "average_difference_percent");
        largest(found.every_average, "rendered_every_luminaire", "average_difference_percent");
        ++found.observers;
    }
    return found;
}

// What the layout names, or an option, is as little replaced as the layout.
TEST_F(Road, NeverReplacesWhatItReads) {
    for (const char* file : {"worked-example.json", "luminaire.ldt", "R3.csv"})
        fs::copy_file(fs::path(VESPER_SOURCE_DIR "/data/road") / file, folder / file);
    const std::string luminaire = text_of("luminaire.ldt"), table = text_of("R3.csv");
    for (const char* arguments : {"--csv luminaire.ldt", "--json luminaire.ldt", "--r-table R3.csv --csv R3.csv",
                                  "--luminaire luminaire.ldt --csv ./luminaire.ldt"}) {
        EXPECT_EQ(run(arguments, "worked-example.json"), 2) << arguments;
        EXPECT_NE(text_of("err.txt").find("would replace what is read"), std::string::npos) << text_of("err.txt");
    }
    EXPECT_EQ(text_of("luminaire.ldt"), luminaire);
    EXPECT_EQ(text_of("R3.csv"), table);
}

// A report that does not get to its file is no success.
TEST_F(Road, SaysWhereItCannotPrint) {
    const std::string command =
        std::string(VESPER_PROGRAM " road " VESPER_SOURCE_DIR "/data/road/worked-example.json >/dev/full 2>'") +
        folder.string() + "/err.txt'";
    const int status = std::system(command.c_str());
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 2);
    EXPECT_EQ(text_of("err.txt"), "vesper: standard output: No space left on device\n");
}

TEST_F(Road, ThePictureOfTheRoadHasItsLuminances) {
    ASSERT_EQ(run("--render a.png --render a.exr --json a.json --csv a.csv"), 0) << text_of("err.txt");
    const Differences found = differences_in(text_of("a.json"));
    EXPECT_EQ(found.observers, 2u);
    EXPECT_LT(found.point, 0.5);
    EXPECT_LT(found.average, 0.1);
    EXPECT_LT(found.every_average, 1);
    EXPECT_GT(found.every_average, 0.1);  // luminaires that the standard leaves out do shine
    const std::string out = text_of("out.txt"), csv = text_of("a.csv");
    EXPECT_NE(out.find("Largest difference: "), std::string::npos) << out;
    EXPECT_NE(csv.find("L_lane1_cd_m2,L_lane2_cd_m2,L_lane1_rendered_cd_m2,L_lane2_rendered_cd_m2"), std::string::npos);
    // The pictures hold what the numbers came from.
    const auto picture = vesper::io::read_hdr_image(folder / "a.lane2.exr");
    EXPECT_EQ(picture.white_luminance, 1);
    EXPECT_NEAR(*std::max_element(picture.rgb.begin(), picture.rgb.end()), 4, 2.5);
    EXPECT_TRUE(fs::exists(folder / "a.png") && fs::exists(folder / "a.lane1.exr"));
}

TEST_F(Road, OtherRoadsAgreeToo) {
    const std::string luminaire = VESPER_SOURCE_DIR "/data/road/luminaire.ldt";
    const char* roads[] = {
        R"("carriageway": {"width_m": 3.5, "lanes": 1, "traffic": "left"}, "surface": {"reflection_table": "W3"}, "luminaires": {"arrangement": "left", "spacing_m": 20, "height_m": 5, "tilt_deg": 10, "colour_temperature_K": 2000,)",
        R"("carriageway": {"width_m": 10.5, "lanes": 3}, "surface": {"reflection_table": "R1", "q0": 0.1}, "luminaires": {"arrangement": "staggered", "spacing_m": 55, "height_m": 12, "overhang_m": -1, "maintenance_factor": 0.7, "orientation_deg": 15,)",
        R"("carriageway": {"width_m": 7, "lanes": 2}, "surface": {"reflection_table": "C2"}, "luminaires": {"arrangement": "central", "reservation_m": 3, "spacing_m": 40, "height_m": 10, "overhang_m": 1, "c0": "street side", "roll_deg": 4,)",
        // Lamps beyond the edge of the table, and so dim that a street would leave them out.
        R"("carriageway": {"width_m": 10.5, "lanes": 3}, "surface": {"reflection_table": "R1"}, "luminaires": {"arrangement": "right", "spacing_m": 16, "height_m": 5, "overhang_m": 0, "flux_factor": 0.001,)"};
    for (const char* road : roads) {
        std::ofstream(folder / "r.json") << R"({"version": 1, "name": "made", )" << road << "\"file\": \"" << luminaire
                                         << "\"}}";
        ASSERT_EQ(run("--render a.png --json a.json", "r.json"), 0) << text_of("err.txt");
        const Differences found = differences_in(text_of("a.json"));
        EXPECT_LT(found.point, 0.5) << road;
        EXPECT_LT(found.average, 0.1) << road;
        EXPECT_GT(found.observers, 0u);
    }
}

// R3 with four times as much at beta 20 as one degree to either side: near a lamp that is 5 cm of road, and is read
// within 0.05 %.
TEST_F(Road, APictureSeesASpikeOfTheTable) {
    std::ifstream in(VESPER_SOURCE_DIR "/data/road/R3.csv");
    std::ofstream table(folder / "spike.csv");
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("#")) continue;
        std::vector<std::string> fields(1);
        for (const char c : line)
            if (c == ',')
                fields.emplace_back();
            else if (c != '\r')
                fields.back() += c;
        for (size_t i = 0; i < fields.size(); ++i) {
            const bool heading = fields[0].starts_with("tan");
            const std::string value = fields[i];
            table << (i > 0 ? "," : "");
            if (i != 6)
                table << value;  // beta 20
            else if (heading)
                table << "19,20,21";
            else if (value.empty())
                table << ",,";
            else
                table << value << "," << 4 * std::stod(value) << "," << value;
        }
        table << "\n";
    }
    table.close();
    std::ofstream(folder / "r.json")
        << R"({"version": 1, "name": "made", "carriageway": {"width_m": 10.5, "lanes": 3}, "surface": {"reflection_table": "spike.csv"},
        "luminaires": {"arrangement": "staggered", "spacing_m": 50, "height_m": 12, "file": ")" VESPER_SOURCE_DIR
           R"(/data/road/luminaire.ldt"}})";
    ASSERT_EQ(run("--render a.png --json a.json", "r.json"), 0) << text_of("err.txt");
    const Differences found = differences_in(text_of("a.json"));
    EXPECT_LT(found.point, 0.5);
    EXPECT_LT(found.average, 0.1);
}

// Seen against a wet road, lamps are no brighter than its average times a hundred; under narrow beams the road itself
// is.
TEST_F(Road, GlareIsOfLampsAlone) {
    for (const char* table : {"W4", "R3"}) {
        std::ofstream(folder / "r.json")
            << R"({"version": 1, "name": "made", "carriageway": {"width_m": 7, "lanes": 2}, "surface": {"reflection_table": ")"
            << table
            << R"("},
            "luminaires": {"arrangement": "staggered", "spacing_m": 25, "height_m": 6, "overhang_m": 1, "file": ")" VESPER_SOURCE_DIR
               R"(/data/road/luminaire.ldt"}})";
        ASSERT_EQ(run("--render a.png --json a.json", "r.json"), 0) << text_of("err.txt");
        for (const auto& observer : nlohmann::json::parse(text_of("a.json"))["observers"]) {
            const double calculated = observer["threshold_increment_percent"],
                         read = observer["rendered"]["threshold_increment_percent"];
            EXPECT_NEAR(read / calculated, 1, 0.01) << table;
        }
    }
}

TEST_F(Road, RefusesInOneLine) {
    for (const char* arguments : {"--r-table R9", "--q0 0", "--spacing 1", "--class P1", "--luminaire none.ies",
                                  "--csv none/a.csv", "--height x", "--stv-map a.jpg", "--stv-map none/a.png",
                                  "--target-reflectance 0.5", "--stv --target-reflectance 0", "--render a.jpg",
                                  "--render none/a.png", "--device cpu", "--render a.png --device nowhere"}) {
        EXPECT_EQ(run(arguments), 2) << arguments;
        const std::string said = text_of("err.txt");
        EXPECT_TRUE(said.starts_with("vesper: ")) << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    }
}

}  // namespace
