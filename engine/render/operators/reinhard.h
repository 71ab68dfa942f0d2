// Reinhard, Stark, Shirley and Ferwerda 2002, global; Reinhard 2003. SPDX-License-Identifier: MIT
#pragma once

#include "render/operators/operator.h"

namespace vesper::render {

struct ReinhardSettings {
    static constexpr OperatorTraits traits{.form = shared::kToneReinhard};

    float key = 0.18f;       ///< luminance the log average is mapped to, relative to white
    bool automatic = false;  ///< Reinhard 2003: key and white from the log average and the 1st and 99th percentile
    float log_epsilon = 0;  ///< cd/m^2 added before logarithms (1e-5 as in his program); 0: none, at least 1e-4 instead
    float white = 0;        ///< cd/m^2 shown as white; 0: the frame's maximum

    template <class Visit>
    static void options(const Visit& visit) {
        using S = ReinhardSettings;
        visit(&S::key, OperatorOption{"key", "",
                                      "reinhard: what the log average is scaled to, relative to white, before "
                                      "compression",
                                      1e-4, 10});
        visit(&S::automatic, OperatorOption{"automatic", "", "reinhard: key and white from the frame (Reinhard 2003)"});
        visit(&S::log_epsilon,
              OperatorOption{"log_epsilon", "cd/m^2",
                             "reinhard: added to luminance before logarithms (his program: 1e-5); 0: none, but "
                             "luminance is at least 1e-4"});
        visit(&S::white,
              OperatorOption{"white", "cd/m^2", "reinhard: luminance shown as white; 0: the maximum", 0, 1e9});
    }
    bool counts_finely() const { return automatic; }
    OperatorBlock block(const vision::Display&) const { return {glm::vec4(key, white, automatic ? 1 : 0, 0)}; }
    static double shown(const shared::ToneCurve& curve, double luminance) {
        const double x = double(curve.block[0].x) * luminance;
        return x * (1 + x * double(curve.block[0].y)) / (1 + x);
    }
};

}  // namespace vesper::render
