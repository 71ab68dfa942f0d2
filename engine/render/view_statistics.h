// What an eye takes of each of several pictures that it sees at once. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/tone.h"

namespace vesper::render {

/// Texels of the foveal level about the place where the eye looks, as the adaptation reads them: at most 4 x 4.
struct FovealTexels {
    glm::uvec2 size{0};             ///< texels
    glm::vec2 gaze{0};              ///< texels from their top left; (0.5, 0.5) is the middle of the first
    std::vector<glm::vec4> texels;  ///< mean luminance, cd/m^2, finite pixels, mean ln luminance, largest luminance
};
/// Of a whole level, row by row; `gaze` likewise.
FovealTexels texels_about(std::span<const glm::vec4> level, glm::uvec2 size, glm::vec2 gaze);

/// Of one picture. Sums of several are exact, or made in their order: they are the same on every machine.
struct ViewStatistics {
    shared::Histogram histogram{};
    glm::vec4 whole{0};  ///< of all pixels, as of a FovealTexels
    FovealTexels fovea;  ///< about the gaze of its settings
    std::vector<glm::vec4>
        colours;  ///< of each tile: RGB, cd/m^2, and finite pixels; of operators that adapt to colour
};

/// Votes of all pictures; their settings have the same electorate (HistogramSettings).
shared::Histogram sum_of_histograms(std::span<const ViewStatistics>);
/// Means and largest luminance of all pixels. Of a single picture, its own.
glm::vec4 whole_of(std::span<const ViewStatistics>);

}  // namespace vesper::render
