// Pattanaik, Tumblin, Yee and Greenberg 2000. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct PattanaikSettings {
    static constexpr OperatorTraits traits{
        .form = shared::kToneColour, .adapt_to = shared::kAdaptAverage, .remembers = true};

    float rod_constant = 5e5f;  ///< of the half saturation of rods; pfstmo_pattanaik00 has 5e4

    template <class Visit>
    static void options(const Visit& visit) {
        visit(&PattanaikSettings::rod_constant,
              OperatorOption{"rod_constant", "", "pattanaik: constant of the rods (pfstmo_pattanaik00: 5e4)", 1, 1e9});
    }
    OperatorBlock block(const vision::Display&) const { return {glm::vec4(rod_constant, 0, 0, 0)}; }
    static double shown(const shared::ToneCurve& curve, double luminance) {
        const glm::dvec4 node = node_at(curve, luminance);
        const double seen = std::clamp(node.x + node.z + double(curve.block[0].x), 0.0, 0.9999999);
        return double(curve.block[0].y) * std::pow(seen / (1 - seen), 1 / double(shared::kResponsePower));
    }
};

}  // namespace vesper::render
