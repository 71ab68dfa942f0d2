// `vesper display` as people run it. SPDX-License-Identifier: MIT
#include <cstdio>

#include "io/image_file.h"
#include "io/read_file.h"
#include "scene/display_file.h"
#include "support/program.h"
#include "vision/display.h"

namespace vesper::test {
namespace {

using DisplayProgram = ProgramTest;

Image read_png(const std::filesystem::path& file) { return io::decode_image(io::read_file(file, 1u << 28), 8192); }

TEST_F(DisplayProgram, WritesPatternsThatHoldTheirCodes) {
    std::filesystem::create_directory(folder / "p");
    ASSERT_EQ(run("display patterns -o p --size 320x200 --patches 5"), 0) << said;
    const auto at = [&](const std::string& name, uint32_t x, uint32_t y) {
        const Image image = read_png(folder / ("p/" + name));
        EXPECT_EQ(image.width, 320u);
        return image.rgba[4 * (size_t{y} * image.width + x)];
    };
    for (const int code : {0, 1, 2, 4, 8, 16, 32, 64, 128, 191, 255}) {
        char name[32];
        std::snprintf(name, sizeof name, "patch-%04d.png", code);
        EXPECT_EQ(at(name, 160, 100), code);
        EXPECT_EQ(at(name, 10, 10), 0) << "around it";
    }
    EXPECT_EQ(at("black.png", 160, 100), 0);
    EXPECT_EQ(at("ramp.png", 319, 5), 255);
    EXPECT_EQ(at("ramp.png", 160, 5), 128);
    EXPECT_EQ(at("near-black.png", 60, 25), 1) << "the second of eight";
    EXPECT_EQ(at("near-white.png", 60, 25), 254);
    EXPECT_EQ(read_text(folder / "p/measurements.csv").substr(0, 17), "code,cd_m2\n0,\n1,\n");
    expect_refused("display fit p/measurements.csv -o x.json", {"p/measurements.csv", "line 2"});
}

TEST_F(DisplayProgram, ATenBitPatternHasItsCodesIn16Bits) {
    std::filesystem::create_directory(folder / "p");
    ASSERT_EQ(run("display patterns -o p --size 64x64 --bits 10 --patches 3 --window 1"), 0) << said;
    // decode_image keeps the upper 8 bits: 512 of 1023.
    EXPECT_EQ(read_png(folder / "p/patch-0512.png").rgba[4 * 32 * 64], 128);
    EXPECT_TRUE(exists("p/patch-1023.png"));
}

TEST_F(DisplayProgram, MakesAProfileThatOtherCommandsTake) {
    std::string table = "code,cd_m2\n";
    const vision::DisplayCurve curve(vision::Display{.peak = 42, .black = 0.07f, .gamma = 2.4f});
    for (const uint32_t code : {0u, 16u, 64u, 128u, 200u, 255u})
        table += std::to_string(code) + "," + std::to_string(curve.emitted(code / 255.0)) + "\n";
    folder.write("m.csv", table);
    ASSERT_EQ(run("display fit m.csv -o wall.json --name wall --ambient 2"), 0) << said;
    EXPECT_NE(printed.find("gamma 2.4"), std::string::npos) << printed;
    EXPECT_NE(printed.find("root mean square"), std::string::npos);
    const vision::Display display = scene::read_display(folder / "wall.json");
    EXPECT_NEAR(double(display.peak), 42, 0.01);
    EXPECT_EQ(display.ambient, 2);
    ASSERT_EQ(run("display fit m.csv -o table.json --kind table"), 0) << said;
    EXPECT_EQ(scene::read_display(folder / "table.json").table.size(), 6u);
    folder.write("empty.gltf", R"({"asset":{"version":"2.0"}})");
    for (const char* name : {"wall.json", "table.json", "projector", "hdr10"})
        EXPECT_EQ(run("render empty.gltf --size 16x8 -o a.png --display " + std::string(name)), 0) << name << said;
    ASSERT_EQ(run("display list"), 0);
    EXPECT_NE(printed.find("projector"), std::string::npos);
}

TEST_F(DisplayProgram, RefusesInOneLine) {
    folder.write("m.csv", "0,0.1\n128,22\n255,100\n");
    folder.write("fall.csv", "0,0.1\n100,50\n128,22\n255,100\n");
    folder.write("empty.gltf", R"({"asset":{"version":"2.0"}})");
    expect_refused("display fit fall.csv -o x.json", {"fall.csv: line 3", "128", "line 2"});
    expect_refused("display fit none.csv -o x.json", {"none.csv"});
    expect_refused("display fit m.csv -o x.txt", {".json"});
    expect_refused("display fit m.csv -o none/x.json", {"none"});
    expect_refused("display patterns -o none", {"none"});
    expect_refused("display patterns -o . --size 5x5", {"5x5"});
    expect_refused("display", {"--help"});
    EXPECT_FALSE(exists("x.json"));
    folder.write("bad.json", R"({"version":1,"eotf":"gamma","gamma":-1})");
    expect_refused("render empty.gltf -o a.png --display bad.json", {"bad.json", "/gamma"});
    expect_refused("render empty.gltf -o a.png --display nowhere", {"nowhere", "projector"});
    expect_refused("render empty.gltf -o a.png --display srgb --display-gamma 2", {"gamma"});
    expect_refused("render empty.gltf -o a.png --display projector --display-peak 0.1 --display-black 1", {"peak"});
}

}  // namespace
}  // namespace vesper::test
