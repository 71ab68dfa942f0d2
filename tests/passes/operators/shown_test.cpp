// What operators do to one luminance, against the reference of whole pixels and against the composite.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <span>
#include <vector>

#include "base/luminance.h"
#include "passes/composite_reference.h"
#include "render/passes/composite.h"
#include "render/tone_mapper.h"
#include "support/texels.h"
#include "support/tones.h"

namespace vesper::test {
namespace {

const vision::Display kDisplays[]{{}, {.peak = 1000, .black = 0.01f, .ambient = 300}};

// A grey pixel as the display shows it; 1e-5, since curves and displays are in float, and logarithms make much of that.
TEST(Shown, IsTheLuminanceOfAGreyPixel) {
    for (const vision::Display& display : kDisplays)
        for (const uint32_t tone : kEveryTone) {
            shared::ToneCurve curve = crooked_curve_of(tone, display);
            // Grey stays grey, since a display cannot show white's luminance in another colour.
            if ((tone & shared::kToneForm) == shared::kToneRods)
                curve.block[1] = glm::vec4(0.2f), curve.block[3].y = 0.96f, curve.block[4].z = 1.05f;
            const double low = double(display.low()), high = double(display.high());
            for (double exponent = -5; exponent <= 8; exponent += 0.13) {
                const double luminance = std::pow(10, exponent);
                const double want = low + (high - low) * reference::luminance(reference::displayed(
                                                             glm::dvec3(luminance), tone, curve, low, high));
                EXPECT_NEAR(
                    render::shown_luminance(render::Operator(tone & shared::kToneForm), curve, luminance, display) /
                        want,
                    1, 1e-5)
                    << "tone " << tone << ", " << luminance << " cd/m^2";
            }
        }
}

// What every operator makes of a frame, and the composite of its grey pixels. 5e-4, since the curve of an operator that
// maps colours by a formula is straight between nodes that are 2.7 % of luminance apart.
TEST(Shown, IsWhatTheCompositeShows) {
    PassRig rig;
    render::ToneMapper mapper(rig.device());
    constexpr VkExtent2D extent{211, 3};
    std::vector<glm::vec4> pixels;
    for (uint32_t i = 0; i < extent.width * extent.height; ++i)
        pixels.emplace_back(glm::vec3(std::pow(10.0f, -3 + 8 * float(i % extent.width) / float(extent.width))), 1);
    for (const vision::Display& display : kDisplays)
        for (const render::OperatorInfo& op : render::operators()) {
            render::ToneChainSettings settings;
            settings.tone_operator = op.tone_operator, settings.display = display;
            const std::span<const float> rgba(&pixels.front().x, pixels.size() * 4);
            mapper.reset_adaptation();
            const shared::ToneCurve curve =
                mapper.map(settings, {.extent = extent, .values = rgba, .channels = 4}, 0).curve;
            graph::FrameGraph graph;
            const render::CompositeInputs inputs{
                rig.image(graph, "scene", render::kSceneFormat, extent, pixels),
                graph.upload("curve", std::vector{curve}, VK_FORMAT_R32G32B32A32_SFLOAT)};
            const graph::Resource light = keep<glm::vec4>(
                graph,
                render::add_display_light(rig.frame(graph, extent), inputs, {.tone = op.form, .display = display}));
            rig.run(graph);
            const std::vector<glm::vec4> composite = rig.got<glm::vec4>(light);
            for (size_t i = 0; i < extent.width; ++i) {
                const double want = std::min(luminance(glm::vec3(composite[i])), double(display.high()));
                const double got = render::shown_luminance(op.tone_operator, curve, double(pixels[i].x), display);
                ASSERT_NEAR(got / want, 1, 5e-4)
                    << op.name << ", " << pixels[i].x << " cd/m^2 at a peak of " << display.peak << " cd/m^2";
            }
        }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test
