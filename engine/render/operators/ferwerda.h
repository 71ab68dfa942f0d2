// Ferwerda, Pattanaik, Shirley and Greenberg 1996. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct FerwerdaSettings : NoOptions {
    static constexpr OperatorTraits traits{.form = shared::kToneRods, .ceiling = shared::kCeilingHuman};

    OperatorBlock block(const vision::Display&) const { return {glm::vec4(1, 1, 1, 0)}; }  // rods add grey
    /// By its luminance as an eye sees it that is adapted to colours, and what rods add.
    static double shown(const shared::ToneCurve& curve, double luminance) {
        const auto sum = [](glm::vec4 row) { return row.x + row.y + row.z; };
        const glm::vec4 rods = curve.block[1];
        const double seen = shared::kRed * (sum(curve.block[2]) + rods.x) +
                            shared::kGreen * (sum(curve.block[3]) + rods.y) +
                            shared::kBlue * (sum(curve.block[4]) + rods.z);
        return (luminance * seen - double(curve.block[0].x)) * double(curve.block[0].y);
    }
};

}  // namespace vesper::render
