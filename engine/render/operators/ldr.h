// No HDR: the baseline of Petit, Bremond and Vienne. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct LdrSettings : NoOptions {
    static constexpr OperatorTraits traits{.form = shared::kToneLdr};

    static double shown(const shared::ToneCurve&, double luminance) { return luminance; }
};

}  // namespace vesper::render
