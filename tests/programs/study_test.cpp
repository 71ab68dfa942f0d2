// `vesper study` as people run it. SPDX-License-Identifier: MIT
#include <cmath>
#include <map>
#include <sstream>

#include "io/read_file.h"
#include "render/passes/operators.h"
#include "support/csv_cells.h"
#include "support/exr_files.h"
#include "support/program.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

/// A street from 0.003 to 300 cd/m^2, with lamps.
io::HdrImage street() {
    io::HdrImage image{160, 100, {}, 0, {}};
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            float l = std::pow(10.0f, -2.5f + 4 * float(x + y) / 260) * (1 + 0.3f * std::sin(0.3f * float(x)));
            if (x % 40 == 7 && y == 12) l = 20000;
            for (const float tint : {1.0f, 0.9f, 0.7f}) image.rgb.push_back(l * tint);
        }
    return image;
}

class StudyProgram : public ProgramTest {
protected:
    using Row = std::map<std::string, std::string>;
    std::vector<Row> csv(const std::string& name, const std::string& heading) {
        std::istringstream in(read_text(folder / name));
        std::string line;
        std::getline(in, line);
        EXPECT_EQ(line, heading);
        const std::vector<std::string> columns = cells_of(line);
        std::vector<Row> rows;
        while (std::getline(in, line)) {
            const std::vector<std::string> values = cells_of(line);
            EXPECT_EQ(values.size(), columns.size()) << line;
            if (values.size() != columns.size()) break;
            for (size_t i = 0; i < columns.size(); ++i) (i ? rows.back() : rows.emplace_back())[columns[i]] = values[i];
        }
        return rows;
    }
    /// Every picture that a page shows is there, and decodes.
    void expect_page(const std::string& page) {
        const std::string text = read_text(folder / page);
        EXPECT_TRUE(text.ends_with("</html>\n"));
        size_t pictures = 0;
        for (size_t at = 0; (at = text.find("src=\"./", at)) != std::string::npos; ++pictures) {
            at += 7;
            std::string name = text.substr(at, text.find('"', at) - at);
            for (size_t blank = 0; (blank = name.find("%20")) != std::string::npos;) name.replace(blank, 3, " ");
            const fs::path file = (folder / page).parent_path() / name;
            ASSERT_TRUE(fs::exists(file)) << file;
            EXPECT_GT(io::decode_image(io::read_file(file, 1u << 28), 32768).width, 0u);
        }
        EXPECT_GT(pictures, 2u);
        for (const auto& entry : fs::directory_iterator((folder / page).parent_path()))
            EXPECT_FALSE(entry.path().filename().string().starts_with(".vesper"));
    }
};

TEST_F(StudyProgram, MoreBinsComeNearerToTheFinest) {
    write_layout(folder / "a street.exr", street(), {.white_luminance = 1});
    ASSERT_EQ(run("study bins 'a street.exr' -o out"), 0) << said;
    EXPECT_EQ(said, "");
    EXPECT_NE(printed.find("Fewest bins from which on"), std::string::npos) << printed;
    EXPECT_NE(printed.find("The default of 100 bins with shared votes is"), std::string::npos) << printed;
    const auto rows =
        csv("out/bins.csv", "picture,operator,votes,bins,curve_codes,largest_codes,percentile99_codes,mean_codes");
    ASSERT_EQ(rows.size(), 3u * 2 * 13) << "operators with a histogram, kinds of votes, bins";
    std::map<std::string, std::map<int, double>> curve;
    for (Row row : rows) {
        EXPECT_EQ(row["picture"], "a street");
        const double difference = std::stod(row["curve_codes"]);
        curve[row["operator"] + row["votes"]][std::stoi(row["bins"])] = difference;
        EXPECT_LE(std::stod(row["mean_codes"]), std::stod(row["percentile99_codes"]) + 1);
        EXPECT_LE(std::stod(row["percentile99_codes"]), std::stod(row["largest_codes"]));
        if (row["bins"] == "256" && row["votes"] == "shared") {
            EXPECT_EQ(difference, 0);
            EXPECT_EQ(row["largest_codes"], "0");
        }
    }
    for (const auto& [name, of_bins] : curve) {
        EXPECT_GT(of_bins.at(16), 0.1) << name;
        if (!name.ends_with("shared")) continue;  // whole votes jump as bins grow narrow
        for (int bins : {64, 100, 128, 200}) EXPECT_LT(of_bins.at(bins), of_bins.at(16) + 0.5) << name << bins;
    }
    expect_page("out/bins.html");
}

// tone-mapping.md, 2.6.
TEST_F(StudyProgram, TheTunnelIsThatOfTheReference) {
    ASSERT_EQ(run("study adaptation -o tunnel"), 0) << said;
    const std::map<double, double> in{{0.05, 17.2}, {0.2, 7.49}, {1, 5.68},  {5, 3.37},
                                      {10, 2.26},   {20, 1.56},  {60, 1.19}, {300, 1.02}};
    const std::map<double, double> out{{0.02, 6.1}, {0.1, 2.7}, {0.5, 1.7}, {2, 1.44}, {10, 0.96}, {60, 0.92}};
    const std::map<double, double> sigma{{0.05, 4204}, {0.2, 1772}, {1, 1317},   {5, 737.8},
                                         {10, 459.0},  {20, 281.1}, {60, 184.3}, {300, 135.9}};
    size_t checked = 0;
    std::map<std::string, int> lines;
    for (Row row : csv("tunnel/adaptation.csv",
                       "operator,step,seconds,luminance,pigment,sigma,threshold,threshold_ratio,shown")) {
        const double seconds = std::stod(row["seconds"]), ratio = std::stod(row["threshold_ratio"]),
                     shown = std::stod(row["shown"]);
        ++lines[row["operator"]];
        EXPECT_GT(shown, 0);
        EXPECT_LT(shown, 101);
        EXPECT_GT(ratio, 0.5);
        EXPECT_EQ(row["threshold"].empty(), row["operator"] == "pattanaik");
        if (row["operator"] != "irawan") continue;
        const auto& table = row["step"] == "in" ? in : out;
        if (const auto found = table.find(seconds); found != table.end()) {
            EXPECT_NEAR(ratio / found->second, 1, 0.02) << row["step"] << seconds;
            ++checked;
        }
        if (row["step"] == "in" && sigma.contains(seconds)) {
            EXPECT_NEAR(std::stod(row["sigma"]) / sigma.at(seconds), 1, 0.02) << seconds;
        }
    }
    EXPECT_EQ(checked, in.size() + out.size());
    EXPECT_EQ(lines.size(), 3u) << "irawan, pattanaik, durand";
    expect_page("tunnel/adaptation.html");
}

TEST_F(StudyProgram, LevelsAreComparedToTheFinest) {
    write_layout(folder / "street.exr", street(), {.white_luminance = 1});
    ASSERT_EQ(run("study mip street.exr -o out/ --operator irawan"), 0) << said;
    const auto rows =
        csv("out/mip.csv",
            "picture,operator,level,degrees,adaptation,curve_codes,largest_codes,percentile99_codes,mean_codes");
    ASSERT_EQ(rows.size(), 7u) << "160 px have seven";
    double degrees = 0;
    for (Row row : rows) {
        if (row["level"] == "1") {
            EXPECT_EQ(std::stod(row["curve_codes"]) + std::stod(row["largest_codes"]), 0);
        } else {
            EXPECT_NEAR(std::stod(row["degrees"]) / degrees, 2, 1e-3);
            EXPECT_GT(std::stod(row["largest_codes"]), 0);
            EXPECT_LE(std::stod(row["largest_codes"]), 255);
        }
        degrees = std::stod(row["degrees"]);
        EXPECT_GT(std::stod(row["adaptation"]), 0.003);
        EXPECT_LT(std::stod(row["adaptation"]), 20000);
    }
    expect_page("out/mip.html");
}

TEST_F(StudyProgram, OperatorsShowContrastAndVisibility) {
    write_layout(folder / "street.exr", street(), {.white_luminance = 1});
    ASSERT_EQ(run("study operators street.exr -o out --contrast 0.5"), 0) << said;
    auto rows = csv("out/operators.csv",
                    "picture,operator,range_scene,range_shown,contrast_scene,contrast_shown,vl_scene,vl_shown,visible_"
                    "scene,visible_shown,lost,gained");
    ASSERT_EQ(rows.size(), render::operators().size() - 1) << "all but ldr";
    for (Row row : rows) {
        EXPECT_EQ(row["contrast_scene"], "0.5");
        EXPECT_EQ(row["vl_scene"], rows[0]["vl_scene"]);
        EXPECT_GT(std::stod(row["range_shown"]), 0);
        EXPECT_LT(std::stod(row["range_shown"]), std::stod(row["range_scene"])) << row["operator"];
        for (const char* share : {"visible_scene", "visible_shown", "lost", "gained"}) {
            EXPECT_GE(std::stod(row[share]), 0);
            EXPECT_LE(std::stod(row[share]), 1);
        }
        EXPECT_NEAR(std::stod(row["visible_scene"]) - std::stod(row["lost"]) + std::stod(row["gained"]),
                    std::stod(row["visible_shown"]), 2e-4);
        EXPECT_LT(std::stod(row["contrast_shown"]), 1) << row["operator"];
    }
    expect_page("out/operators.html");
    expect_refused("study operators street.exr -o out --operator ldr", {"ldr"});
    expect_refused("study operators street.exr -o out --contrast 0");
    expect_refused("study mip street.exr -o out --fov 40 --operator linear", {"linear", "histogram"});
}

// A linear display of the whole range loses contrast that visibility matching keeps, and every display sees the same
// scene.
TEST_F(StudyProgram, FidelityTellsWhatDisplaysLose) {
    write_layout(folder / "street.exr", street(), {.white_luminance = 1});
    ASSERT_EQ(run("study fidelity street.exr --fov 3 --displays desk,projector -o out"), 0) << said;
    auto rows = csv("out/fidelity.csv", "picture,display,operator,seen,lost,invented,amplified,saliency");
    ASSERT_EQ(rows.size(), 2 * (render::operators().size() - 1)) << "all but ldr, on two displays";
    std::map<std::string, Row> first;
    for (Row row : rows) {
        EXPECT_EQ(row["seen"], rows[0]["seen"]) << row["operator"];
        EXPECT_GT(std::stod(row["seen"]), 0.01);
        EXPECT_LE(std::stod(row["lost"]) + std::stod(row["amplified"]), std::stod(row["seen"]));
        EXPECT_LE(std::stod(row["seen"]) + std::stod(row["invented"]), 1);
        if (row["display"] == "desk") first[row["operator"]] = row;
    }
    EXPECT_GT(std::stod(first["linear"]["lost"]), 2 * std::stod(first["ward"]["lost"]) + 0.01);
    expect_page("out/fidelity.html");
    // What describes a display changes each of --displays.
    ASSERT_EQ(run("study fidelity street.exr --fov 3 --displays desk,projector --display-ambient 10000 --operator ward "
                  "-o bright"),
              0)
        << said;
    for (Row row : csv("bright/fidelity.csv", "picture,display,operator,seen,lost,invented,amplified,saliency"))
        EXPECT_GT(std::stod(row["lost"]), 1.5 * std::stod(first["ward"]["lost"])) << row["display"];
    expect_refused("study fidelity street.exr --fov 3 -o out --displays desk --display projector", {"--displays"});
    expect_refused("study fidelity street.exr --fov 3 -o out --displays none.json", {"none.json"});
    expect_refused("study fidelity street.exr --fov 3 -o out --glare cie", {"--glare"});
    write_layout(folder / "relative.exr", street(), {});
    EXPECT_EQ(run("study fidelity relative.exr --fov 3 -o out"), 2) << "no unit";
    EXPECT_NE(said.find("--unit"), std::string::npos) << said;
}

TEST_F(StudyProgram, RefusesInOneLine) {
    write_layout(folder / "a.exr", street(), {.white_luminance = 1});
    fs::create_directory(folder / "b");
    fs::copy(folder / "a.exr", folder / "b/a.exr");
    io::HdrImage black = street();
    for (float& value : black.rgb) value = 0;
    write_layout(folder / "black.exr", black, {.white_luminance = 1});
    folder.write("text.hdr", "no picture");
    for (const char* arguments : {"",
                                  "nothing -o x",
                                  "bins -o x",
                                  "bins a.exr",
                                  "bins none.exr -o x",
                                  "bins a.exr b/a.exr -o x",
                                  "bins text.hdr -o x",
                                  "bins black.exr -o x",
                                  "bins a.exr -o none/x",
                                  "bins a.exr -o a.exr",
                                  "bins a.exr -o x --operator reinhard",
                                  "bins a.exr -o x --unit 0",
                                  "bins a.exr -o x --unit fog",
                                  "bins a.exr -o x --size 5",
                                  "bins a.exr -o x --device nowhere",
                                  "adaptation",
                                  "adaptation -o x --outside 0",
                                  "adaptation -o x --seconds -1",
                                  "adaptation -o x --operator ward",
                                  "adaptation a.exr -o x"})
        expect_refused(std::string("study ") + arguments);
    expect_refused("study bins a.exr -o x --operator reinhard", {"reinhard", "histogram"});
    expect_refused("study bins black.exr -o x", {"black.exr", "no light"});
}

}  // namespace
}  // namespace vesper::test
