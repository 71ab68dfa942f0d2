// Samples of pixels from the command line. SPDX-License-Identifier: MIT
#include <numeric>

#include "io/hdr_image.h"
#include "support/luminous_square.h"

namespace vesper::test::samples_program_test {
namespace {

/// A square of 1 m and 100 cd/m^2 at 2 m, a third of a pixel beside the middle of the picture.
std::string square() { return luminous_square({0.01f, 0, -2, 1, 0, -2, 1, 1, -2, 0.01f, 1, -2}); }

class SamplesProgram : public ProgramTest {
protected:
    void SetUp() override { folder.write("a.gltf", square()); }
    std::vector<float> picture(const std::string& name) const { return io::read_exr(folder / name).rgb; }
    static double sum(const std::vector<float>& rgb) { return std::accumulate(rgb.begin(), rgb.end(), 0.0); }
    const std::string render = "render a.gltf --size 40x40 --indirect off ";
};

TEST_F(SamplesProgram, TheLightOfManyIsThatOfTheArea) {
    ASSERT_EQ(run(render + "--samples 64 -o many.exr"), 0) << said;
    ASSERT_EQ(run(render + "--samples 64 -o again.exr"), 0) << said;
    ASSERT_EQ(run(render + "--samples 1 -o one.exr"), 0) << said;
    ASSERT_EQ(run(render + "--anti-aliasing off -o off.exr"), 0) << said;
    EXPECT_EQ(picture("many.exr"), picture("again.exr"));
    const double pixel = 4 * std::tan(0.5) / 40, want = 3 * 100 * 0.99 * 1 / (pixel * pixel);
    EXPECT_NEAR(sum(picture("many.exr")), want, 0.002 * want);
    EXPECT_NEAR(sum(picture("one.exr")), want, 0.01 * want);
    EXPECT_GT(std::abs(sum(picture("off.exr")) - want), 0.01 * want) << "whole pixels";
}

TEST_F(SamplesProgram, TheMeanOfWhatTheDisplayShowsIsAnother) {
    ASSERT_EQ(run(render + "--samples 8 -o luminance.png"), 0) << said;
    ASSERT_EQ(run(render + "--samples 8 --display-average -o shown.png"), 0) << said;
    EXPECT_NE(read_text(folder / "luminance.png"), read_text(folder / "shown.png"));
    const std::string field = std::string("vesper:displayAverage") + '\0';
    EXPECT_NE(read_text(folder / "shown.png").find(field + "on"), std::string::npos);
    EXPECT_NE(read_text(folder / "luminance.png").find(field + "off"), std::string::npos);
}

TEST_F(SamplesProgram, RefusesWhatHasNoMeaning) {
    for (const char* number : {"0", "-1", "65537", "1e3", "many", "4.5"})
        expect_refused(render + "-o a.png --samples " + number, {"--samples"});
    expect_refused(render + "-o a.png --anti-aliasing=maybe", {"--anti-aliasing"});
    expect_refused("render a.gltf --paths 16 --samples 4 -o a.png", {"--samples", "--paths"});
    expect_refused(render + "--display-average -o a.png", {"--display-average", "--samples"});
    expect_refused(render + "--samples 4 --display-average -o a.exr", {"--display-average", ".png"});
    EXPECT_FALSE(exists("a.png"));
}

}  // namespace
}  // namespace vesper::test::samples_program_test
