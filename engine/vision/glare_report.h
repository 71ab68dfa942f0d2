// Figures of glare: veiling luminance, threshold increment, visibility. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "vision/scatter_fit.h"

namespace vesper::vision {

/// Light at the eye from one direction (view frame: x right, y up, along -z).
struct DazzlingLight {
    glm::dvec3 direction{0, 0, -1};
    double illuminance = 0;  ///< lx, on a plane facing the source
};

/// A rectangle of a picture, parts of it from its top left corner.
struct MarkedTarget {
    glm::dvec2 corner{0}, size{0};
};

constexpr double kSourceContrast = 100;

struct GlareQuestion {
    ScatteringEye eye;
    glm::dvec2 gaze{0.5};  ///< the line of sight, parts of the picture from its top left
    /// cd/m^2: a brighter pixel is part of a glare source. Default: kSourceContrast times the log average of the pixels
    /// above 1e-4 cd/m^2, or the mean of all pixels where that is less.
    std::optional<double> source_luminance = {};
    std::optional<double> average_luminance;  ///< cd/m^2, of the road, for TI; default: GlareReport::background
    std::optional<MarkedTarget> target;
};

struct GlareReport {
    double background = 0;   ///< cd/m^2: mean of the pixels within 10 degrees of the line of sight that are no sources
    double illuminance = 0;  ///< lx, of all sources on a plane at right angles to the line of sight
    double veil = 0;         ///< cd/m^2, on the line of sight: CIE general equation (CIE 146:2002)
    double road_veil = 0;    ///< cd/m^2, likewise, with the equations of EN 13201-3
    double increment = 0;    ///< TI, %, of road_veil; infinite where the average luminance is 0 and road_veil is not
    /// Of the marked target, looked at: its luminance and that of a frame of its own width around it, the veil there
    /// (CIE general), and its visibility level (vision/visibility.h) with the veil over both; 0 in the dark. cd/m^2.
    double target = 0, around = 0, target_veil = 0, visibility = 0;
    /// Pupil, mm, and seed of the eye whose needles and halo are shown; 0 without. The caller that shows them fills
    /// these in.
    double pupil = 0, eye_seed = 0;
};

/// Computes the figures of a picture (RGBA rows from the top, cd/m^2 RGB in linear Rec. 709) and of light from outside
/// of it. Sources within 0.1 degrees of the line of sight do not count as glare. Pixels that are not finite have no
/// light. Throws Error for a target without a pixel in it or around it.
GlareReport report_glare(const ImageAngles&, std::span<const float> rgba, std::span<const DazzlingLight> outside,
                         const GlareQuestion&);

}  // namespace vesper::vision
