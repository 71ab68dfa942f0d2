// Drago, Myszkowski, Annen and Chiba 2003. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "render/operators/operator.h"

namespace vesper::render {

struct DragoSettings {
    static constexpr OperatorTraits traits{};

    float bias = 0.85f;  ///< less lifts dark parts

    template <class Visit>
    static void options(const Visit& visit) {
        visit(&DragoSettings::bias,
              OperatorOption{"bias", "", "drago: less lifts dark parts, more keeps the contrast of bright ones", 0.5});
    }
    OperatorBlock block(const vision::Display&) const { return {glm::vec4(std::log(bias) / std::log(0.5f), 0, 0, 0)}; }
};

}  // namespace vesper::render
