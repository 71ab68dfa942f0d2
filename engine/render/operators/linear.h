// Linear between two luminances. SPDX-License-Identifier: MIT
#pragma once

#include "base/error.h"
#include "render/operators/operator.h"

namespace vesper::render {

struct LinearSettings {
    static constexpr OperatorTraits traits{.form = shared::kToneLinear};

    float low = 0;   ///< cd/m^2 shown as black
    float high = 0;  ///< cd/m^2 shown as white; 0: the frame's maximum

    template <class Visit>
    static void options(const Visit& visit) {
        using S = LinearSettings;
        visit(&S::low, OperatorOption{"linear_min", "cd/m^2", "linear: luminance shown as black", 0, 1e9});
        visit(&S::high,
              OperatorOption{"linear_max", "cd/m^2", "linear: luminance shown as white; 0: the maximum", 0, 1e9});
    }
    void check() const {
        if (high > 0 && high <= low) throw Error("--linear-max must be more than --linear-min");
    }
    OperatorBlock block(const vision::Display&) const { return {glm::vec4(low, high, 0, 0)}; }
    static double shown(const shared::ToneCurve& curve, double luminance) {
        return (luminance - double(curve.block[0].x)) * double(curve.block[0].y);
    }
};

}  // namespace vesper::render
