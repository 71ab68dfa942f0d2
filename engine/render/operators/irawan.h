// Irawan, Ferwerda and Marschner 2005, reconstructed. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct IrawanSettings : NoOptions {
    static constexpr OperatorTraits traits{.remembers = true, .histogram = true};
};

}  // namespace vesper::render
