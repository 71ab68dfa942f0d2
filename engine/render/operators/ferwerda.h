// Ferwerda, Pattanaik, Shirley and Greenberg 1996. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper {

struct FerwerdaSettings : NoOptions {
    static constexpr OperatorTraits traits{.form = shared::kToneRods, .ceiling = shared::kCeilingHuman};

    OperatorBlock block(const Display&) const { return {glm::vec4(1, 1, 1, 0)}; }  // rods add grey
};

}  // namespace vesper
