// One eye that sees several pictures: what it takes of each, and that it adapts as to one.
// SPDX-License-Identifier: MIT
#include "render/shared_eye.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "render/tone_mapper.h"

namespace vesper::test::shared_eye_test {
namespace {

using render::Operator, render::ViewStatistics;

constexpr uint32_t kSide = 64;
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

// A street at night: dim, with lamps, colours, and pixels that are not finite.
std::vector<float> picture(uint32_t width, uint32_t height, uint32_t from = 0, uint32_t to = ~0u) {
    std::vector<float> rgb;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            if (x < from || x >= to) continue;
            const float light = x % 31 == 5 && y % 17 == 3 ? 3e4f : 0.02f + 0.5f * float(x * y % 23);
            if (x == 7 && y == 9)
                rgb.insert(rgb.end(), {kNotANumber, 1, 1});
            else
                rgb.insert(rgb.end(), {light, 0.7f * light, 0.4f * light});
        }
    return rgb;
}

render::ToneChainSettings settings_of(Operator op) {
    render::ToneChainSettings settings;
    settings.tone_operator = op;
    settings.foveal_level = 3;
    return settings;
}

ViewStatistics measure(render::SharedEye& eye, const render::ToneChainSettings& settings,
                       const render::HostPicture& picture) {
    render::StoredPicture light, retina;
    eye.upload(picture, light);
    return eye.see(settings, light, {}, 0, light.view(), retina).statistics;
}

// Of one picture: the very curve and eye of a mapper, over time, whatever the operator.
TEST(SharedEye, SeesOnePictureAsAMapperDoes) {
    gpu::Device device({.select = ""});
    const std::vector<float> rgb = picture(75, 41);
    const render::HostPicture seen{.extent = {75, 41}, .values = rgb};
    for (const render::OperatorInfo& op : render::operators()) {
        if (op.tone_operator == Operator::Ldr) continue;
        render::ToneChainSettings settings = settings_of(op.tone_operator);
        settings.tone.gaze = {0.31f, 0.96f};
        render::ToneMapper mapper(device);
        render::SharedEye eye(device);
        render::StoredPicture light, retina;
        for (const float seconds : {0.0f, 0.1f, 3.0f}) {
            const render::ToneMapped want = mapper.map(settings, seen, seconds);
            eye.upload(seen, light);
            const ViewStatistics statistics = eye.see(settings, light, {}, seconds, light.view(), retina).statistics;
            const render::ToneMapped got = eye.adapt(settings, std::span(&statistics, 1), 0, seconds);
            EXPECT_EQ(std::memcmp(&got.curve, &want.curve, sizeof got.curve), 0) << op.name;
            EXPECT_EQ(std::memcmp(&got.eye, &want.eye, sizeof got.eye), 0) << op.name;
            EXPECT_EQ(std::memcmp(&got.histogram, &want.histogram, sizeof got.histogram), 0) << op.name;
            EXPECT_EQ(eye.show(settings, retina, got.curve, {}).display, want.display) << op.name;
        }
    }
}

// Retinas of a picture that is cut out of a larger one: the middle of what a mapper's whole retina has, to the bit; and
// the light of nodes is that of the picture.
TEST(SharedEye, KeepsTheMiddleOfAPicture) {
    gpu::Device device({.select = ""});
    const std::vector<float> rgb = picture(75, 41);
    const render::HostPicture whole{.extent = {75, 41}, .values = rgb};
    render::ToneChainSettings settings = settings_of(Operator::Irawan);
    settings.glare = render::Glare::Scatter;
    render::ToneMapper mapper(device);
    const render::ToneMapped want = mapper.map(settings, whole, 0, {.display = false, .retina = true});
    render::SharedEye eye(device);
    render::StoredPicture light, retina;
    eye.upload(whole, light);
    gpu_scene::View shown = light.view();
    shown.extent = {75 - 2 * 12, 41 - 2 * 12};
    eye.see(settings, light, {}, 0, shown, retina);
    const std::vector<float> got = eye.read(retina);
    ASSERT_EQ(got.size(), size_t{4} * 51 * 17);
    for (size_t y = 0; y < 17; ++y)
        EXPECT_EQ(std::memcmp(&got[4 * 51 * y], &want.retina[4 * (75 * (y + 12) + 12)], 16 * 51), 0) << y;
    EXPECT_EQ(eye.read(light).size(), size_t{4} * 75 * 41);
    const std::vector<uint32_t> nodes{0, 76};
    const std::vector<glm::vec3> sums = eye.light_of(light, nodes);
    ASSERT_EQ(sums.size(), 2u);
    EXPECT_NEAR(sums[0].y / sums[0].x, 0.7, 1e-5);  // as the picture has them
    EXPECT_NEAR(sums[1].z / sums[1].x, 0.4, 1e-5);
}

// Of a picture that is cut between texels that vote: its votes to the last one, and its means as far as floats are good
// (1e-6 of sums of 8192 pixels in pairs).
TEST(SharedEye, PartsOfAPictureAddUpToIt) {
    gpu::Device device({.select = ""});
    render::SharedEye eye(device), one(device);
    render::ToneChainSettings settings = settings_of(Operator::Devlin);
    settings.histogram.overlap = false;  // whose texels lie across a cut
    settings.histogram.electorate = 2 * kSide * kSide;
    const auto part = [&](uint32_t from, uint32_t to) {
        const std::vector<float> rgb = picture(2 * kSide, kSide, from, to);
        return measure(eye, settings, {.extent = {to - from, kSide}, .values = rgb});
    };
    const ViewStatistics whole = part(0, 2 * kSide);
    const std::vector<ViewStatistics> parts{part(0, 32), part(32, 2 * kSide)};
    const shared::Histogram sum = sum_of_histograms(parts);
    EXPECT_GT(whole.histogram.votes, 0u);
    EXPECT_EQ(whole.histogram.non_finite, 1u);
    EXPECT_EQ(std::memcmp(&sum, &whole.histogram, sizeof sum), 0);
    const glm::vec4 all = whole_of(parts);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(all[i] / whole.whole[i], 1, 1e-5) << i;
    EXPECT_EQ(parts[0].colours.size() + parts[1].colours.size(), whole.colours.size());

    const render::ToneMapped of_parts = eye.adapt(settings, parts, 1, 0),
                             of_whole = one.adapt(settings, std::span(&whole, 1), 0, 0);
    EXPECT_NEAR(of_parts.curve.log_average / of_whole.curve.log_average, 1, 1e-5);
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(of_parts.curve.block[1][i] / of_whole.curve.block[1][i], 1, 1e-4) << "mean colour " << i;
}

// A picture without anything that is finite has no say, and one alone leaves the eye as it was.
TEST(SharedEye, DarknessIsNotANumber) {
    gpu::Device device({.select = ""});
    render::SharedEye eye(device);
    const render::ToneChainSettings settings = settings_of(Operator::Irawan);
    const std::vector<float> none(size_t(3) * 37 * 23, kNotANumber), some = picture(37, 23);
    const std::vector<ViewStatistics> both{measure(eye, settings, {.extent = {37, 23}, .values = none}),
                                           measure(eye, settings, {.extent = {37, 23}, .values = some})};
    const glm::vec4 all = whole_of(both);
    EXPECT_EQ(all, whole_of(std::span(both).last(1)));
    const render::ToneMapped seen = eye.adapt(settings, both, 1, 0);
    EXPECT_TRUE(std::isfinite(seen.curve.adaptation) && seen.curve.adaptation > 0);
    const render::ToneMapped kept = eye.adapt(settings, std::span(both).first(1), 0, 1);
    EXPECT_EQ(kept.curve.adaptation, seen.curve.adaptation);
}

// The texels about a gaze are those that lie 1 before to 2 behind the one below it, less half a texel.
TEST(SharedEye, TakesTheTexelsThatTheGazeReads) {
    std::vector<glm::vec4> level;
    for (int i = 0; i < 7 * 5; ++i) level.emplace_back(float(i), 1, 0, 0);
    const render::FovealTexels middle = render::texels_about(level, {7, 5}, {3.25f, 2.5f});
    EXPECT_EQ(middle.size, glm::uvec2(4, 4));
    EXPECT_EQ(middle.texels.front().x, 1 * 7 + 1);
    EXPECT_EQ(middle.texels.back().x, 4 * 7 + 4);
    EXPECT_EQ(middle.gaze, glm::vec2(2.25f, 1.5f));
    const render::FovealTexels corner = render::texels_about(level, {7, 5}, {0, 5});
    EXPECT_EQ(corner.size, glm::uvec2(2, 2));
    EXPECT_EQ(corner.texels.front().x, 3 * 7);
    EXPECT_EQ(corner.gaze, glm::vec2(0, 2));
}

}  // namespace
}  // namespace vesper::test::shared_eye_test
