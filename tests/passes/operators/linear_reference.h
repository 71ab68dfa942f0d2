// Linear between two luminances. SPDX-License-Identifier: MIT
#pragma once

#include "passes/operators/operator_reference.h"

namespace vesper::reference {

inline void linear_frame(const OperatorFrame& f, Adapted& out) {
    const glm::vec4 set = f.in.parameters.settings[0];
    const double high = set.y != 0 ? double(set.y) : f.maximum;
    out.tone.block[0] = {set.x, float(1 / std::max(high - double(set.x), kFloor)), 0, 0};
}

}  // namespace vesper::reference
