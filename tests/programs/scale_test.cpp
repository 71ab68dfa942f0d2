// Pictures that are rendered smaller than they are shown, and how many threads make them.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "io/hdr_image.h"
#include "io/image_file.h"
#include "io/read_file.h"
#include "support/luminous_square.h"

namespace vesper::test::scale_test {
namespace {

/// The lower half of what the eye sees emits 100 cd/m^2.
std::string lower_half() { return luminous_square({-9, -9, -2, 9, -9, -2, 9, 0, -2, -9, 0, -2}); }

std::string value(const io::HdrImage& image, const std::string& key) {
    const auto found = std::ranges::find(image.header, key, [](const auto& entry) { return entry.first; });
    return found == image.header.end() ? "none" : found->second;
}

class Scale : public ProgramTest {
protected:
    void SetUp() override { folder.write("a.gltf", lower_half()); }
    const std::string render = "render a.gltf --indirect off --operator linear ";
};

TEST_F(Scale, CodesHaveTheSizeAskedForAndLuminancesThatOfTheRendered) {
    ASSERT_EQ(run(render + "--size 61x40 --scale 0.5 -o a.png -o a.exr --stats-json a.json"), 0) << said;
    EXPECT_NE(said.find("note: pictures of 61x40 are rendered as 31x20 and enlarged (--scale 0.5)"), said.npos) << said;
    const auto shown = io::decode_image(io::read_file(folder / "a.png", 1u << 20), 64);
    EXPECT_EQ(shown.width, 61u);
    EXPECT_EQ(shown.height, 40u);
    const io::HdrImage light = io::read_exr(folder / "a.exr");
    EXPECT_EQ(light.width, 31u);
    EXPECT_EQ(light.height, 20u);
    EXPECT_EQ(value(light, "vesper:scale"), "0.5");
    EXPECT_NE(read_text(folder / "a.png").find("vesper:scale"), std::string::npos);
    EXPECT_NE(read_text(folder / "a.json").find("\"scale\": 0.5"), std::string::npos);
    // The view stays: its edges, and the horizon in the middle.
    ASSERT_EQ(run(render + "--size 61x40 -o b.exr"), 0) << said;
    EXPECT_EQ(said.find("enlarged"), said.npos) << said;
    const io::HdrImage whole = io::read_exr(folder / "b.exr");
    EXPECT_EQ(value(whole, "vesper:scale"), "1");
    EXPECT_EQ(value(whole, "vesper:tangents"), value(light, "vesper:tangents"));
    for (uint32_t y = 0; y < 20; ++y)
        EXPECT_NEAR(light.rgb[size_t{3} * (size_t{31} * y + 15)], y < 10 ? 0.0f : 100.0f, 1e-3f) << y;
}

TEST_F(Scale, OneIsNone) {
    ASSERT_EQ(run(render + "--size 32x20 -o a.png"), 0) << said;
    ASSERT_EQ(run(render + "--size 32x20 --scale 1 -o b.png"), 0) << said;
    EXPECT_EQ(said.find("enlarged"), said.npos) << said;
    EXPECT_EQ(read_text(folder / "a.png"), read_text(folder / "b.png"));
}

TEST_F(Scale, RefusesOthers) {
    for (const char* scale : {"0.2", "1.1", "0", "-1", "nan", "half"})
        expect_refused(render + "-o a.png --scale " + scale, {"--scale"});
}

TEST_F(Scale, ThreadsChangeNothing) {
    ASSERT_EQ(run(render + "--size 61x40 --threads 1 -o a.exr --stats-json a.json"), 0) << said;
    ASSERT_EQ(run(render + "--size 61x40 --threads 3 -o b.exr --stats-json b.json"), 0) << said;
    EXPECT_EQ(read_text(folder / "a.exr"), read_text(folder / "b.exr")) << "files of ranks are those of one process";
    EXPECT_NE(read_text(folder / "a.json").find("\"threads\": 1,"), std::string::npos);
    EXPECT_NE(read_text(folder / "b.json").find("\"threads\": 3,"), std::string::npos);
    for (const char* number : {"0", "-1", "1025", "all"})
        expect_refused(render + "-o a.png --threads " + number, {"--threads"});
}

class DriveScale : public ProgramTest {
protected:
    DriveScale() : ProgramTest(VESPER_DRIVE) {}
};

TEST_F(DriveScale, IsInPicturesAndInTheLog) {
    const std::string drive = "--headless --autopilot --seconds 0.1 --shadows off --indirect off --size 64x40 ";
    ASSERT_EQ(run(drive + "--scale 0.25 --video a%d.png --log a.csv --record a.json"), 0) << said;
    EXPECT_NE(said.find("64x40 are rendered as 16x10"), said.npos) << said;
    EXPECT_EQ(io::decode_image(io::read_file(folder / "a0.png", 1u << 20), 64).width, 64u);
    EXPECT_NE(read_text(folder / "a.csv").find(",16,10,"), std::string::npos);
    const std::string png = read_text(folder / "a0.png");
    EXPECT_NE(png.find(std::string("vesper:scale\0000.25", 17)), png.npos);
    EXPECT_NE(png.find(std::string("vesper:quality\0standard", 23)), png.npos);
    ASSERT_EQ(run(drive + "--scale 0.25 --quality fast --video b%d.exr"), 0) << said;
    const io::HdrImage light = io::read_exr(folder / "b0.exr");
    EXPECT_EQ(light.width, 16u);
    EXPECT_EQ(light.height, 10u);
    EXPECT_EQ(value(light, "vesper:scale"), "0.25");
    EXPECT_EQ(value(light, "vesper:quality"), "fast");
    EXPECT_EQ(value(light, "vesper:mergeError"), "0.01");
    ASSERT_EQ(run("--headless --replay a.json --video b%d.exr"), 0) << said;
    EXPECT_EQ(io::read_exr(folder / "b0.exr").width, 64u) << "a recording is of whole pictures";
    ASSERT_EQ(run("--headless --replay a.json --quality fast --video b%d.exr"), 0) << said;
    EXPECT_EQ(io::read_exr(folder / "b0.exr").width, 32u) << "without --scale that of the quality holds";
    ASSERT_EQ(run(drive + "--quality fast --record b.json --log b.csv"), 0) << said;
    ASSERT_EQ(run("--headless --replay b.json --video b%d.exr"), 0) << said;
    EXPECT_EQ(io::read_exr(folder / "b0.exr").width, 32u) << "of a recorded one, too";
    if (std::system("command -v ffmpeg >/dev/null") == 0) {
        ASSERT_EQ(run(drive + "--scale 0.5 --video a.mp4"), 0) << said;
        EXPECT_NE(read_text(folder / "a.mp4").find("vesper:scale=0.5"), std::string::npos);
    }
    folder.write("c.json", R"({"channels":[{"name":"a","size_px":[8,8]}]})");
    expect_refused(drive + "--scale 0.5 --channels c.json --log a.csv", {"--s", "channels"});
}

}  // namespace
}  // namespace vesper::test::scale_test
