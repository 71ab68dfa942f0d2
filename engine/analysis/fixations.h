// Where an eye looks that follows a map of saliency, and how alike two maps are. SPDX-License-Identifier: MIT
// Pure functions in double, without a device.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "vision/image_angles.h"

namespace vesper::analysis {

/// A map over a picture: values of squares of `texel` px, rows from the top left corner of the picture.
struct PictureMap {
    size_t width = 0, height = 0;  ///< texels
    double texel = 1;              ///< px
    std::span<const float> values;
};

/// A place that draws the eye.
struct Fixation {
    glm::dvec2 pixels{0};  ///< from the top left corner: the middle of a texel, within the picture
    double value = 0;      ///< of the map there
};

/// Angle between the directions of two points of a picture (px), rad.
double angle_between(const vision::ImageAngles& picture, glm::dvec2 a, glm::dvec2 b);

/// The greatest value wins, and then all within `radius` (rad) of it is inhibited; at most `most` times, and only where
/// the map is above 0 (winner take all and inhibition of return, Itti, Koch and Niebur 1998). Of equal values the first
/// in the order of rows wins. Values that are not finite never do. Throws Error if the map does not have as many values
/// as texels.
std::vector<Fixation> fixations(const PictureMap& map, const vision::ImageAngles& picture, double radius, size_t most);

/// Spearman's rank correlation, from -1 to 1: of ranks that are means where values are equal. Nothing if one of the
/// lists is all equal, or they have fewer than two values. Throws Error if the lists are not of one length or hold
/// values that are not finite.
std::optional<double> rank_correlation(std::span<const float> a, std::span<const float> b);

}  // namespace vesper::analysis
