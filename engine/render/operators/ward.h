// Ward Larson, Rushmeier and Piatko 1997. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct WardSettings : NoOptions {
    static constexpr OperatorTraits traits{
        .ceiling = shared::kCeilingHuman, .adapt_to = shared::kAdaptAverage, .histogram = true};
};

}  // namespace vesper::render
