// Grave and Bremond 2008, reconstructed. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct GraveSettings : NoOptions {
    static constexpr OperatorTraits traits{.ceiling = shared::kCeilingCones, .histogram = true, .bands = true};
};

}  // namespace vesper::render
