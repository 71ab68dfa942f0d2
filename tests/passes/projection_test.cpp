// What a projector shows on the device, against its reference. SPDX-License-Identifier: MIT
#include "passes/projection_reference.h"

#include <random>

#include "render/passes/projection.h"
#include "support/compare.h"
#include "support/complaints.h"
#include "support/displays.h"
#include "support/texels.h"

namespace vesper::test::projection_test {
namespace {

using eye::Projection;

// Beyond half a code that rounding takes, of white: the products of float weights are right to some 3e-7 of the light,
// of which a code of 10 bits near black is no larger part.
constexpr double kBeyond = 1e-6;

/// Light from 1e-4 to 1, saturated and grey, some of none.
std::vector<glm::vec4> light_of(VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> decades(-4, 0), unit(0, 1);
    std::vector<glm::vec4> texels;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const glm::vec3 tint = i % 3 ? glm::vec3(unit(random), unit(random), unit(random)) : glm::vec3(1);
        texels.emplace_back(i % 17 ? tint * std::pow(10.0f, decades(random)) : glm::vec3(0), 1);
    }
    return texels;
}

/// Any places, inside the picture and beyond it, and exact ones; any factors, and pixels that are not drawn.
Projection projection_for(VkExtent2D picture, VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    Projection made{picture, extent, {}};
    const glm::vec2 size(picture.width, picture.height);
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        glm::vec2 at = (1.2f * glm::vec2(unit(random), unit(random)) - 0.1f) * size;
        if (i % 5 == 0) at = glm::floor(at) + 0.5f;
        made.pixels.push_back({at, i % 7 == 0 ? 1 : i % 7 == 1 ? 0 : i % 7 == 2 ? eye::kNotDrawn : unit(random)});
    }
    return made;
}

std::vector<uint32_t> words_of(PassRig& rig, const std::vector<glm::vec4>& light, const Projection& projection,
                               const render::ProjectionSettings& settings) {
    graph::FrameGraph graph;
    const graph::Resource picture = rig.image(graph, "light", render::kShownLightFormat, projection.picture, light);
    const graph::Resource kept = keep<uint32_t>(
        graph, render::add_projection(rig.frame(graph, projection.picture), picture, projection, settings));
    rig.run(graph);
    return rig.got<uint32_t>(kept);
}

void expect_reference(const std::vector<uint32_t>& words, const std::vector<glm::vec4>& light,
                      const Projection& projection, const render::ProjectionSettings& settings) {
    const auto [width, height] = projection.extent;
    const vision::Display& display = settings.display;
    Picture got(width, height, 3), want = got;
    ASSERT_EQ(words.size(), size_t{width} * height);
    for (size_t i = 0; i < words.size(); ++i) {
        const glm::dvec3 codes = reference::projected(std::span<const glm::vec4>(light), projection.picture.width,
                                                      projection.picture.height, projection.pixels[i], display);
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t place = settings.blue_first ? 2 - c : c;
            got.values[3 * i + c] = words[i] >> place * display.bits & display.largest_code();
            want.values[3 * i + c] = codes[int(c)];
        }
        ASSERT_EQ(words[i] >> 3 * display.bits, display.bits == 8 ? 255u : 3u) << "alpha";
    }
    EXPECT_TRUE(same_codes("projection", got, want, kBeyond * display.largest_code()));
}

TEST(ProjectionPass, MatchesTheReferenceAtAwkwardSizes) {
    PassRig rig;
    for (const VkExtent2D picture : {VkExtent2D{1, 1}, {37, 23}, {131, 67}})
        for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {66, 35}, {37, 23}}) {
            const auto light = light_of(picture, picture.width);
            const Projection projection = projection_for(picture, extent, extent.width);
            expect_reference(words_of(rig, light, projection, {}), light, projection, {});
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(ProjectionPass, MatchesTheReferenceForEveryKindOfDisplay) {
    PassRig rig;
    const VkExtent2D picture{40, 30}, extent{70, 41};
    for (const vision::Display& display : every_kind_of_display())
        for (const bool blue_first : {false, true}) {
            const auto light = light_of(picture, 3);
            const Projection projection = projection_for(picture, extent, 4);
            const render::ProjectionSettings settings{display, blue_first};
            expect_reference(words_of(rig, light, projection, settings), light, projection, settings);
        }
    EXPECT_EQ(rig.complaints(), "");
}

// The middle of a pixel shows that pixel and nothing of its neighbours, whatever they are.
TEST(ProjectionPass, MiddlesOfPixelsAreExact) {
    PassRig rig;
    const VkExtent2D extent{65, 3};
    const auto light = light_of(extent, 5);
    const vision::Display display{.bits = 10};
    const auto words = words_of(rig, light, eye::projection_of(extent, extent), {display});
    const vision::DisplayCurve curve(display);
    for (size_t i = 0; i < words.size(); ++i)
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t code = words[i] >> 10 * c & 1023;
            const double shown = 0.1 + 99.9 * double(light[i][int(c)]);  // cd/m^2 in the dark
            // The nearest code: the light lies between those half a code below and above, which are floats.
            ASSERT_GE(shown, curve.emitted((code - 0.5) / 1023) * (1 - 1e-6)) << i;
            ASSERT_LE(shown, curve.emitted((code + 0.5) / 1023) * (1 + 1e-6)) << i;
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(ProjectionPass, OfAnotherPictureIsRefused) {
    PassRig rig;
    graph::FrameGraph graph;
    const graph::Resource light = rig.image(graph, "light", render::kShownLightFormat, {3, 2}, light_of({3, 2}, 1));
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{3, 2});
    const auto complaint = [&](const Projection& projection) {
        return complaint_of([&] { render::add_projection(frame, light, projection, {}); });
    };
    EXPECT_TRUE(contains(complaint(eye::projection_of({2, 3}, {5, 5})),
                         "a projection of a picture of 2 x 3 px cannot show one of 3 x 2 px"));
    Projection broken = eye::projection_of({3, 2}, {5, 5});
    broken.pixels.pop_back();
    EXPECT_TRUE(contains(complaint(broken), "a projection to 5 x 5 px does not have 24 pixels"));
    EXPECT_TRUE(contains(complaint({{3, 2}, {0, 0}, {}}), "does not have 0 pixels"));
    EXPECT_EQ(complaint(eye::projection_of({3, 2}, {5, 5})), "");
}

}  // namespace
}  // namespace vesper::test::projection_test
