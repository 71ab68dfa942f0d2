// Khronos PBR Neutral 2024: a baseline for comparison, not psychophysical. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct NeutralSettings {
    static constexpr OperatorTraits traits{.form = 11};

    float white = 0;  ///< cd/m^2 that is 1 before the curve; 0: the log average is 0.18

    template <class Visit>
    static void options(const Visit& visit) {
        visit(&NeutralSettings::white,
              OperatorOption{"neutral_white", "cd/m^2",
                             "neutral: luminance that is 1 before the curve; 0: the log average is 0.18", 0, 1e9});
    }
    OperatorBlock block(const vision::Display&) const { return {glm::vec4(white, 0, 0, 0)}; }
};

}  // namespace vesper::render
