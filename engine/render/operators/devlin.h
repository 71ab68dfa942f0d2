// Reinhard and Devlin 2005. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "render/operators/operator.h"

namespace vesper::render {

struct DevlinSettings {
    static constexpr OperatorTraits traits{.form = 10, .chromatic = true};

    float intensity = 0;                ///< f'
    float contrast = 0;                 ///< m; 0: from the key of the frame
    float light_adaptation = 0.75f;     ///< a: 0 to the frame, 1 to the pixel; default as pfstools 2.2.0, paper: 1
    float chromatic_adaptation = 0.5f;  ///< c: 0 to luminance, 1 to each channel; default as pfstools 2.2.0, paper: 0

    template <class Visit>
    static void options(const Visit& visit) {
        using S = DevlinSettings;
        visit(&S::intensity, OperatorOption{"devlin_intensity", "", "devlin: more is brighter", -8, 8});
        visit(&S::contrast, OperatorOption{"devlin_contrast", "",
                                           "devlin: exponent of the half saturation, 0.3 to 1; 0: from the frame"});
        visit(&S::light_adaptation, OperatorOption{"devlin_light_adaptation", "",
                                                   "devlin: receptors adapt to the frame (0) or to their pixel (1)"});
        visit(&S::chromatic_adaptation,
              OperatorOption{"devlin_chromatic_adaptation", "",
                             "devlin: receptors adapt to luminance (0) or to their channel (1)"});
    }
    bool counts_finely() const { return true; }
    OperatorBlock block(const vision::Display&) const {
        return {glm::vec4(std::exp(-intensity), contrast, light_adaptation, chromatic_adaptation)};
    }
};

}  // namespace vesper::render
