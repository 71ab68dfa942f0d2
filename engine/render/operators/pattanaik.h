// Pattanaik, Tumblin, Yee and Greenberg 2000. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper {

struct PattanaikSettings {
    static constexpr OperatorTraits traits{
        .form = shared::kToneColour, .adapt_to = shared::kAdaptAverage, .remembers = true};

    float rod_constant = 5e5f;  ///< of the half saturation of rods; pfstmo_pattanaik00 has 5e4

    template <class Visit>
    void options(const Visit& visit) {
        visit(OperatorOption{"--rod-constant", "pattanaik: constant of the rods (pfstmo_pattanaik00: 5e4)", 1, 1e9},
              rod_constant);
    }
    OperatorBlock block(const Display&) const { return {glm::vec4(rod_constant, 0, 0, 0)}; }
};

}  // namespace vesper
