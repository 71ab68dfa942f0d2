// `vesper merge` as people run it. SPDX-License-Identifier: MIT
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include "io/jpeg_files.h"
#include "io/new_file.h"
#include "photometry/brackets.h"
#include "places.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

class MergeProgram : public testing::Test {
protected:
    TempFolder folder;
    io::HdrImage scene = night(96, 72);
    std::string said, printed;

    void SetUp() override {
        CameraNoise random;
        for (uint32_t i = 0; i < 8; ++i) {
            // 1/200 s, f/4, ISO 100, and two stops more each time: by time, then by f-number, then by ISO speed.
            const auto photo = photograph(scene, srgb_camera(), 0.005 * std::pow(4, i), random);
            const uint32_t over = 1u << 2 * std::min(i, 4u);
            const auto app1 =
                exif_of(over, 200, i < 5 ? 4 : 2, 1, static_cast<uint16_t>(i < 6 ? 100 : 100u << 2 * (i - 5)));
            io::replace_file(folder / ("p" + std::to_string(i) + ".jpg"), jpeg_with(96, 72, photo.image.rgba, app1));
            io::write_png(folder / ("q" + std::to_string(i) + ".png"), 96, 72, photo.image.rgba);
        }
    }
    int merge(const std::string& arguments) {
        const std::string command =
            "cd " + folder.path().string() + " && " VESPER_PROGRAM " merge " + arguments + " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        said = read_text(folder / "err.txt");
        printed = read_text(folder / "out.txt");
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    /// The median of log10 of merged over true green, and how far from it 95 % of the pixels are at most.
    std::pair<double, double> compare(const io::HdrImage& merged) const {
        std::vector<double> logs;
        for (size_t i = 1; i < merged.rgb.size(); i += 3)
            logs.push_back(std::log(static_cast<double>(merged.rgb[i] / scene.rgb[i])));
        std::sort(logs.begin(), logs.end());
        return {std::exp(logs[logs.size() / 2]), (logs[logs.size() * 97 / 100] - logs[logs.size() * 3 / 100]) / 2};
    }
};

TEST_F(MergeProgram, MergesJpegsByTheirExif) {
    ASSERT_EQ(merge("p3.jpg p1.jpg p0.jpg p2.jpg p7.jpg p4.jpg p5.jpg p6.jpg --response r.csv -o a.exr"), 0) << said;
    EXPECT_TRUE(contains(printed, "response of G") && contains(printed, "decades") &&
                contains(printed, "never well exposed"))
        << printed;
    const io::HdrImage merged = io::read_hdr_image(folder / "a.exr");
    EXPECT_EQ(merged.white_luminance, 0.0);
    EXPECT_LT(compare(merged).second, 0.05);
    EXPECT_LT(response_error(photometry::read_response(folder / "r.csv"), srgb_camera(), 1, 24, 231), 0.05);
    ASSERT_EQ(merge("p0.jpg p1.jpg p2.jpg p3.jpg p4.jpg p5.jpg p6.jpg p7.jpg --curve r.csv --unit 2 -o b.exr"), 0)
        << said;
    const io::HdrImage again = io::read_hdr_image(folder / "b.exr");
    EXPECT_EQ(again.white_luminance, 1.0);
    EXPECT_NEAR(again.rgb[300] / merged.rgb[300], 2, 1e-4);
}

TEST_F(MergeProgram, ScalesToAMeasuredLuminance) {
    const float* p = scene.rgb.data() + 3 * (30 * 96 + 20);
    const double known = 0.212639 * static_cast<double>(p[0]) + 0.715169 * static_cast<double>(p[1]) +
                         0.072192 * static_cast<double>(p[2]);
    const std::string files =
        "q0.png q1.png q2.png q3.png q4.png q5.png q6.png q7.png --exposures 1/200,1/50,0.08,.32,1.28,5.12,20.48,81.92 "
        "--curve srgb ";
    ASSERT_EQ(merge(files + "--luminance 20,30," + std::to_string(known) + " -o a.exr"), 0) << said;
    const auto [scale, spread] = compare(io::read_hdr_image(folder / "a.exr"));
    EXPECT_NEAR(scale, 1, 0.03);
    EXPECT_LT(spread, 0.05);
    EXPECT_TRUE(contains(printed, "cd/m^2"));
}

TEST_F(MergeProgram, RefusesInOneLine) {
    folder.write("bad.png", "\x89PNG\r\n\x1a\n");
    folder.write("r.csv", "code,\n");
    io::write_png(folder / "small.png", 2, 2, std::vector<uint8_t>(16, 100));
    for (const char* arguments : {"",
                                  "q0.png -o a.exr",
                                  "q0.png q1.png -o a.exr",
                                  "q0.png q1.png -e 1 -o a.exr",
                                  "q0.png q1.png -e 1,0 -o a.exr",
                                  "q0.png q1.png -e 1,x -o a.exr",
                                  "q0.png q1.png -e 1,nan -o a.exr",
                                  "q0.png q1.png -e 1,1 -o a.exr",
                                  "q0.png q1.png -e 1,2",
                                  "q0.png q1.png -e 1,2 -o a.png",
                                  "q0.png q1.png -e 1,2 -o none/a.exr",
                                  "q0.png q1.png -e 1,2 -o a.exr --response none/r.csv",
                                  "q0.png none.png -e 1,2 -o a.exr",
                                  "q0.png bad.png -e 1,2 -o a.exr",
                                  "q0.png small.png -e 1,2 -o a.exr",
                                  "q0.png q1.png -e 1,2 -o a.exr --curve r.csv",
                                  "q5.png q6.png -e 1,4 -o a.exr --luminance 5,5",
                                  "q5.png q6.png -e 1,4 -o a.exr --luminance 5000,5,1",
                                  "q5.png q6.png -e 1,4 -o a.exr --luminance 5.5,5,1",
                                  "q5.png q6.png -e 1,4 -o a.exr --luminance 5,5,1 --unit 2",
                                  "p0.jpg q1.png -o a.exr"}) {
        EXPECT_EQ(merge(arguments), 2) << arguments;
        std::string lines = said;
        while (lines.starts_with("warning: ")) lines.erase(0, lines.find('\n') + 1);
        EXPECT_TRUE(lines.starts_with("vesper: ")) << arguments << ": " << said;
        EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << arguments << ": " << said;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
    EXPECT_EQ(merge("--help"), 0);
    EXPECT_TRUE(contains(printed, "Example"));
}

}  // namespace
}  // namespace vesper::test
