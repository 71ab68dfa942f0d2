// The share of a round lamp that is seen past a straight edge: closed form. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "base/angle.h"

namespace vesper::reference {

/// The share of a disc of radius 1 at x > from.
inline double disc_beyond(double from) {
    const double x = std::clamp(from, -1.0, 1.0);
    return (std::acos(x) - x * std::sqrt(1 - x * x)) / kPi;
}

/// The share that a place x of the ground sees of a lamp, a level disc of this radius over x = 0 at `lamp_height`, past
/// an edge along z at (edge, height), with what lies at smaller x hidden; m.
inline double past_edge(double x, double edge, double height, double lamp_height, double radius) {
    return disc_beyond((x + (edge - x) * lamp_height / height) / radius);
}

}  // namespace vesper::reference
