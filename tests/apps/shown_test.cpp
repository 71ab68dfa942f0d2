// What tone curves do to one luminance, against the reference of whole pixels. SPDX-License-Identifier: MIT
#include "shown.h"

#include <gtest/gtest.h>

#include "passes/composite_reference.h"
#include "support/tones.h"

namespace vesper::test {
namespace {

// A grey pixel as the display shows it; 1e-5, since curves and displays are in float, and logarithms make much of that.
TEST(Shown, IsTheLuminanceOfAGreyPixel) {
    for (const Display& display : {Display{}, Display{.peak = 1000, .black = 0.01f, .ambient = 300}})
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
                EXPECT_NEAR(shown_luminance(curve, tone, luminance, display) / want, 1, 1e-5)
                    << "tone " << tone << ", " << luminance << " cd/m^2";
            }
        }
}

}  // namespace
}  // namespace vesper::test
