// Glare as people run it: lamps beside a picture, what is reported, what is refused. SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "base/angle.h"
#include "io/hdr_image.h"
#include "io/image_file.h"
#include "io/read_file.h"
#include "places.h"
#include "support/exr_files.h"
#include "support/program.h"
#include "vision/glare.h"

namespace vesper::test {
namespace {

class GlareProgram : public ProgramTest {
protected:
    void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
    std::string header(const std::string& name, const std::string& key) {
        for (const auto& [k, value] : io::read_exr(folder / name).header)
            if (k == key) return value;
        return "none";
    }
    /// A value of a CSV file, by column and line; the first line is the heading.
    std::string cell(const std::string& name, const std::string& column, size_t line) {
        std::istringstream lines(read_text(folder / name));
        std::vector<std::vector<std::string>> rows;
        for (std::string text; std::getline(lines, text);) {
            rows.emplace_back();
            std::istringstream row(text);
            for (std::string value; std::getline(row, value, ',');) rows.back().push_back(value);
        }
        for (size_t i = 0; line < rows.size() && i < rows[0].size(); ++i)
            if (rows[0][i] == column) return rows[line].at(i);
        return "none";
    }
    /// A lamp of 20 cd, ten metres ahead and `aside` metres to the right.
    void write_lamp(double aside) {
        write("lamp.gltf",
              R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],)"
              R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":20}]}},)"
              R"("cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],)"
              R"("nodes":[{"name":"eye","camera":0},{"name":"lamp, old","translation":[)" +
                  std::to_string(aside) +
                  R"(,0,-10],"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
                  R"("extras":{"vesper":{"version":1,"openings":[{"light":0,"width_m":0.1,"height_m":0.1}]}}})");
    }
};

// A black picture and a lamp 10 degrees beside its middle: what is shown is the veil.
TEST_F(GlareProgram, ALampElsewhereVeilsABlackPicture) {
    write_layout(folder / "black.exr", {64, 40, std::vector<float>(size_t{3} * 64 * 40, 0), 0, {}}, {});
    write("lamps.csv", "azimuth,elevation,lux\n# beside and below\n10, 0, 5\n0,-40,1\r\n\n");
    ASSERT_EQ(run("tonemap black.exr --fov 8 --glare cie --age 60 --iris 1 --lamps lamps.csv --operator linear "
                  "--linear-max 10 --display-peak 100 --display-black 0.001 -o out.exr"),
              0)
        << said;
    const io::HdrImage shown = io::read_hdr_image(folder / "out.exr");
    const vision::EyeScatter psf([](double theta) { return vision::cie_total_glare(theta, {60, 1}); });
    for (const int column : {3, 32, 60}) {
        const double x = (column + 0.5 - 32) / 20 * std::tan(4 / kDegreesPerRadian),
                     y = (20.5 - 20) / 20 * std::tan(4 / kDegreesPerRadian);
        const double theta = std::acos((x * std::sin(10 / kDegreesPerRadian) + std::cos(10 / kDegreesPerRadian)) /
                                       std::sqrt(1 + x * x + y * y)) *
                             kDegreesPerRadian;
        const double other = std::acos((y * std::sin(40 / kDegreesPerRadian) + std::cos(40 / kDegreesPerRadian)) /
                                       std::sqrt(1 + x * x + y * y)) *
                             kDegreesPerRadian;
        const double veil = 5 * psf(theta) + psf(other);
        // 7 %: the pyramid's own error; most of it is less.
        EXPECT_NEAR(shown.rgb[size_t(3 * (20 * 64 + column))] / (0.001 + 99.999 * veil / 10), 1, 0.07) << column;
    }
    EXPECT_EQ(header("out.exr", "vesper:glare"), "cie");
    EXPECT_EQ(header("out.exr", "vesper:age"), "60");
    const double e = 5 * std::cos(10 / kDegreesPerRadian), below = std::cos(40 / kDegreesPerRadian);
    EXPECT_NEAR(std::stod(header("out.exr", "vesper:glare:veil")),
                e * vision::cie_general_glare(10, {60, 1}) + below * vision::cie_general_glare(40, {60, 1}), 1e-6);
}

// Other columns or units than there are would be read as what they are not.
TEST_F(GlareProgram, HeadingsOfLampListsAreRead) {
    write_layout(folder / "black.exr", {16, 10, std::vector<float>(size_t{3} * 16 * 10, 0), 0, {}}, {});
    const auto veil = [&](const std::string& text) {
        write("lamps.csv", text);
        return run("tonemap black.exr --unit 1 --fov 8 --glare cie --lamps lamps.csv -o out.exr") == 0
                   ? header("out.exr", "vesper:glare:veil")
                   : said;
    };
    const std::string wanted = veil("20,0,5\n");
    for (const char* good :
         {"azimuth,elevation,lx\n20,0,5\n", "azimuth [deg]; elevation [deg]; E_v [lx]\n20;0;5,0\n",
          "# lamps\nto the right\tup\tilluminance\n20\t0\t5\n", "azimuth,elevation,illuminance\ndeg,deg,lx\n20,0,5\n",
          "lamp azimuth, lamp elevation, light intensity (lux)\n20, 0,\t5\n", "20,0\t0\t5,0\n", "\"20\",\"0\",\"5\"\n"})
        EXPECT_NEAR(std::stod("0" + veil(good)), std::stod("0" + wanted), 1e-6) << good << said;
    for (const char* bad : {"lx,azimuth,elevation\n5,20,0\n", "azimuth_rad,elevation_rad,lx\n1,0,5\n",
                            "azimuthRad,elevation,lx\n1,0,5\n", "azimuth,elevation,cd\n20,0,5\n",
                            "azimuth,elevation,E_mlx\n20,0,5\n", "left,up,lx\n20,0,5\n", "azimuth,down,lx\n20,0,5\n",
                            "el,az,lx\n20,0,5\n", "a,b,c\n20,0,5\n", "frame,lamp,azimuth,elevation\n0,x,20,0\n"})
        EXPECT_NE(veil(bad).find("lamps.csv: line 1: "), std::string::npos) << bad << said;
    for (const char* bad : {"20,0,x\n", "20,0,5\na,b,c\n", "20;0,5\n", "20\xc2\xb0,0\xc2\xb0,5 lx\n10,0,1\n",
                            "20 deg,0 deg,5 lx\n", "20..0,0..0,5..0\n"})
        EXPECT_NE(veil(bad).find("lamps.csv: line "), std::string::npos) << bad << said;
}

TEST_F(GlareProgram, LampsAreReportedInsideAndOutsideThePicture) {
    for (const double aside : {0.5, 12.0}) {
        write_lamp(aside);
        ASSERT_EQ(run("render lamp.gltf --size 80x50 --glare cie --log log.csv --glare-sources lamps.csv --target "
                      "0.45,0.4,0.1,0.2 -o a.exr -o a.png"),
                  0)
            << said;
        const double square = 100 + aside * aside;
        EXPECT_EQ(cell("lamps.csv", "lamp", 1), "lamp  old") << "no comma of its own";
        EXPECT_NEAR(std::stod(cell("lamps.csv", "candela", 1)), 20, 1e-4);
        EXPECT_NEAR(std::stod(cell("lamps.csv", "lux", 1)), 20 / square, 1e-4 * 20 / square);
        EXPECT_NEAR(std::stod(cell("lamps.csv", "azimuth", 1)), std::atan(aside / 10) * kDegreesPerRadian, 1e-3);
        EXPECT_EQ(cell("lamps.csv", "inside", 1), aside < 1 ? "1.000" : "0.000");
        // Seen or not, the veil is that of the lamp.
        const double theta = std::atan(aside / 10) * kDegreesPerRadian,
                     want = 20 / square * std::cos(theta / kDegreesPerRadian) *
                            vision::cie_general_glare(theta, {23, 0.5});
        // 5 %: a pixel is 0.57 degrees, and the light is taken to come from its middle.
        EXPECT_NEAR(std::stod(cell("log.csv", "veil", 1)) / want, 1, 0.05) << aside;
        EXPECT_EQ(header("a.exr", "vesper:glare:veil").substr(0, 6), cell("log.csv", "veil", 1).substr(0, 6));
        EXPECT_NE(cell("log.csv", "visibility", 1), "none");
    }
}

TEST_F(GlareProgram, EveryModelRuns) {
    write_lamp(0.3);
    for (const char* glare : {"none", "ldr", "cie", "spencer", "spencer --pupil scotopic", "cie --age 70 --iris 0",
                              "temporal", "temporal --lashes --eye-seed 7"})
        EXPECT_EQ(run("render lamp.gltf --size 33x21 -o a.png --glare " + std::string(glare)), 0) << said;
    ASSERT_EQ(run("render lamp.gltf --size 33x21 --plan --glare cie"), 0) << said;
    for (const char* pass : {"scatter up 1", "scatter top", "scatter down 0"})
        EXPECT_NE(printed.find(pass), std::string::npos) << pass;
}

TEST_F(GlareProgram, TemporalGlareIsTheSameForTheSameSeedAndTimes) {
    write_lamp(0.3);
    const std::string render = "render lamp.gltf --size 120x80 --glare temporal --operator ward ";
    ASSERT_EQ(run(render + "--frames 4 --dt 0.1 --log log.csv -o a.%04d.png -o a.%04d.exr"), 0) << said;
    ASSERT_EQ(run(render + "--frames 4 --dt 0.1 -o b.%04d.png"), 0) << said;
    ASSERT_EQ(run(render + "--replay log.csv --frames 2 --start 0.15 -o c.%04d.png"), 0) << said;
    ASSERT_EQ(run(render + "--eye-seed 2 -o d.png"), 0) << said;
    for (const char* frame : {"0000", "0001", "0002", "0003"})
        EXPECT_EQ(read_text(folder / ("a." + std::string(frame) + ".png")),
                  read_text(folder / ("b." + std::string(frame) + ".png")))
            << frame;
    EXPECT_EQ(read_text(folder / "c.0000.png"), read_text(folder / "a.0002.png")) << "from the log";
    EXPECT_EQ(read_text(folder / "c.0001.png"), read_text(folder / "a.0003.png"));
    EXPECT_NE(read_text(folder / "a.0000.png"), read_text(folder / "a.0003.png")) << "it moves";
    EXPECT_NE(read_text(folder / "a.0000.png"), read_text(folder / "d.png")) << "another eye";
    EXPECT_EQ(cell("log.csv", "eye_seed", 1), "1");
    const double pupil = std::stod(cell("log.csv", "pupil", 1));
    EXPECT_TRUE(pupil > 3 && pupil < 8) << pupil;
    EXPECT_EQ(header("a.0000.exr", "vesper:glare"), "temporal");
    EXPECT_EQ(header("a.0000.exr", "vesper:glare:pupil"), cell("log.csv", "pupil", 1));
    // A picture of other origin is dazzled by what it shows.
    ASSERT_EQ(run("tonemap a.0000.exr --glare temporal --operator ward -o e.png"), 0) << said;
    // The files differ: a rendering's header says how its pixels were averaged.
    const auto pixels = [&](const std::string& name) {
        return io::decode_image(io::read_file(folder / name, 1u << 20), 120).rgba;
    };
    EXPECT_EQ(pixels("e.png"), pixels("a.0000.png"));
}

TEST_F(GlareProgram, RefusesInOneLine) {
    write_lamp(0);
    write("words.csv", "1,2,bright\n");
    write("two.csv", "0,0,1\n5,5\n");
    write("four.csv", "0,0,1,2\n");
    write("far.csv", "0,95,1\n");
    write("dark.csv", "0,5,-1\n");
    expect_refused("render lamp.gltf -o a.png --glare cie --operator ldr", {"ldr"});
    for (const char* name : {"words.csv", "four.csv", "far.csv", "dark.csv"})
        expect_refused("render lamp.gltf -o a.png --glare cie --lamps " + std::string(name), {name, "line 1"});
    expect_refused("render lamp.gltf -o a.png --glare cie --lamps two.csv", {"two.csv", "line 2"});
    expect_refused("render lamp.gltf -o a.png --lamps none.csv", {"none.csv"});
    expect_refused("render lamp.gltf --log two.csv --lamps two.csv", {"two.csv"});
}

// The worked road example: TI of 15.0 % (lane 2, R3), calculated and off a picture.
TEST_F(GlareProgram, ThresholdIncrementOfTheRoadIsThatOfItsPicture) {
    ASSERT_EQ(run("road '" VESPER_SOURCE_DIR "/data/road/worked-example.json' --render a.png --json a.json"), 0)
        << said;
    const auto json = nlohmann::json::parse(read_text(folder / "a.json"));
    double worst = 0, seen = 0;
    for (const auto& observer : json["observers"]) {
        const double calculated = observer["threshold_increment_percent"],
                     rendered = observer["rendered"]["threshold_increment_percent"];
        EXPECT_NEAR(rendered, calculated, 1);
        worst = std::max(worst, calculated), seen = std::max(seen, rendered);
    }
    EXPECT_NEAR(worst, 15, 0.2);
    EXPECT_NEAR(seen, 15, 1);
}

}  // namespace
}  // namespace vesper::test
