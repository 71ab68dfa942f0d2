// Pattanaik, Tumblin, Yee and Greenberg 2000. SPDX-License-Identifier: MIT
#pragma once

#include "passes/operators/operator_reference.h"

namespace vesper::reference {

/// Node i of Pattanaik's table: from 1e-4 to 1e8 cd/m^2.
inline dvec3 lagging_node(const analysis::pattanaik::Appearance& appearance, uint32_t i,
                          const shared::ToneParameters& p) {
    const double luminance = std::pow(10, -4 + 12.0 * i / shared::kMaxNodes);
    return {appearance.cones(luminance), appearance(luminance, luminance).colour_exponent,
            appearance.rods(p.scotopic * luminance)};
}

inline void pattanaik_frame(const OperatorFrame& f, Adapted& out) {
    const shared::PattanaikState& before = f.in.previous.pattanaik;
    const shared::ToneParameters& p = f.in.parameters;
    out.pattanaik = f.first || !(before.cones > 0)
                        ? analysis::pattanaik::adapted(f.adaptation, f.scotopic)
                        : analysis::pattanaik::after(out.pattanaik, f.adaptation, f.scotopic, p.seconds);
    const analysis::pattanaik::Appearance appearance(out.pattanaik, p.settings[0].x);
    shared::ToneCurve& t = out.tone;
    t.ln_low = float(std::log(1e-4)), t.bins = float(shared::kMaxNodes),
    t.bins_per_ln = float(shared::kMaxNodes / std::log(1e12));
    t.block[0] = {float(appearance.offset()), float(analysis::pattanaik::cone_sigma(25) / 125), 0, 0};
    for (uint32_t i = 0; i <= shared::kMaxNodes; ++i)
        t.node[i] = glm::vec4(glm::vec3(lagging_node(appearance, i, p)), 0);
}

}  // namespace vesper::reference
