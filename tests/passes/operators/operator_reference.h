// What the reference of an operator reads and writes. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <numeric>
#include <vector>

#include "analysis/pattanaik.h"
#include "passes/anchor_reference.h"
#include "passes/pyramid_reference.h"
#include "render/passes/operators.h"
#include "shared/tone.h"
#include "vision/eye.h"

namespace vesper::reference {

/// Everything the pass of adaptation reads.
struct AdaptInputs {
    shared::Histogram histogram{};
    dvec4 top{0};  ///< the 1x1 level of the pyramid
    PyramidLevel fovea;
    shared::EyeState previous{};
    shared::ToneParameters parameters{};
    vision::Observer observer;
    render::Operator tone_operator = render::Operator::Irawan;
    PyramidLevel colours;  ///< tiles; empty: the eye does not adapt to colour
};

/// Everything the pass writes, in double where it matters.
struct Adapted {
    Adjusted adjusted;
    vision::ReceptorState cones, rods;
    std::vector<double> share;
    analysis::pattanaik::State pattanaik;
    shared::ToneCurve tone{};
    shared::EyeState eye{};
};

/// A frame on its way through the pass.
struct OperatorFrame {
    const AdaptInputs& in;
    bool empty, first;
    double log_average, mean, maximum, adaptation, scotopic;
    const vision::ReceptorModel &cones, &rods;
    double cone_sigma, rod_sigma;
    vision::ThresholdBreaks breaks;
};

/// A table that does not depend on the histogram: `shown`, relative to the display's range, of 1e-4 to 1e8 cd/m^2.
template <class Shown>
void write_table(const shared::ToneParameters& p, shared::ToneCurve& curve, const Shown& shown) {
    curve.ln_low = float(std::log(1e-4)), curve.bins = float(shared::kMaxNodes);
    curve.bins_per_ln = float(shared::kMaxNodes / std::log(1e12));
    const double low = p.display_low, range = double(p.display_high) - low;
    for (uint32_t i = 0; i <= shared::kMaxNodes; ++i) {
        const double relative = std::clamp(double(shown(std::pow(10, -4 + 12.0 * i / shared::kMaxNodes))), 0.0, 1.0);
        curve.node[i] = {float(std::log(low + range * relative)), 0, 0, 0};
    }
}

/// An operator that keeps its reference in its own test: the numbers and the table that it makes of a frame, and, if it
/// maps colours, the light that it shows of a pixel, 1 for white.
struct OperatorReference {
    void (*frame)(const OperatorFrame&, Adapted&) = nullptr;
    dvec3 (*rgb)(const shared::ToneCurve&, dvec3 rgb) = nullptr;
};
inline std::map<render::Operator, OperatorReference>& operator_references() {
    static std::map<render::Operator, OperatorReference> all;
    return all;
}
/// A variable of this type makes a reference known.
struct KnownReference {
    KnownReference(render::Operator op, OperatorReference reference) { operator_references()[op] = reference; }
};

}  // namespace vesper::reference
