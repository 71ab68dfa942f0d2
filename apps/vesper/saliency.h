// What `vesper saliency` finds. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "analysis/fixations.h"
#include "analysis/saliency_mapper.h"
#include "study_picture.h"

namespace vesper::commands {

/// A place of the scene that draws the eye.
struct SalientPlace {
    glm::dvec2 pixels{0}, degrees{0};          ///< from the top left corner; right and up from the middle
    double mean_luminance = 0, brightest = 0;  ///< of the texel of the map, cd/m^2
    double saliency = 0;                       ///< over that of the first place
    std::optional<size_t> on_display;          ///< which of the display's places lies there, from 1
};

/// A picture, and what its tone-mapped picture keeps of it.
struct SaliencyFindings {
    std::string file, tone_operator;
    const StudyPicture* picture = nullptr;
    vision::ImageAngles angles;
    double radius = 0;  ///< of inhibition, degrees
    analysis::SaliencyMap scene, display;
    std::vector<SalientPlace> places;
    size_t display_places = 0;
    std::optional<double> rank_correlation;
};

/// Draws the picture in grey under the map, with numbered places. Throws Error.
void save_saliency(const std::string& file, const SaliencyFindings&);
/// The same for programs.
nlohmann::ordered_json json_of(const SaliencyFindings&);

}  // namespace vesper::commands
