// Durand and Dorsey 2000, reconstructed. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct DurandSettings : NoOptions {
    static constexpr OperatorTraits traits{.form = shared::kToneRods, .remembers = true, .chromatic = true};

    OperatorBlock block(const vision::Display&) const { return {glm::vec4(1.05f, 0.97f, 1.27f, 0)}; }  // rods add blue
};

}  // namespace vesper::render
