// Needles and halo of one eye, frame by frame, as the device reads them. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "eye/scatter.h"
#include "vision/glare_pattern.h"

namespace vesper::eye {

/// Needles and halo around a lamp in one frame.
struct Corona {
    std::vector<glm::vec4> texels;  ///< of shared/corona.h
    double pupil = 0;               ///< mm, its unrest included; 0: of a model without one
    double milliseconds = 0;        ///< that making it took on the host; 0: it is that of the frame before
};

/// The texels of a pattern, with its means.
std::vector<glm::vec4> corona_texels(const vision::GlarePattern&);

/// Makes the pattern of each frame, or keeps that of the last one.
class CoronaCache {
public:
    /// `pupil`: what the frame before left of it (EyeState), mm; 0: there was none. `seconds` since the first frame.
    const Corona& at(const ScatterSettings&, double pupil, double seconds);

private:
    struct Moment {
        ScatterSettings settings;
        double pupil, seconds;
        bool operator==(const Moment&) const = default;
    };
    std::optional<Moment> moment_;
    std::optional<vision::EyeAperture> aperture_;
    Corona corona_;
};

}  // namespace vesper::eye
