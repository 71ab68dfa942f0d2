// Figures of a measured lamp: flux, axes, widths, cut-off. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "photometry/distribution.h"

namespace vesper::photometry {

/// Intensity at C and gamma, or H and V, deg; C may be any turn.
double intensity_at(const Distribution&, double h, double v);

/// A cut through a distribution: intensities over angles.
struct Cut {
    std::vector<double> angle;  ///< deg, ascending
    std::vector<double> candela;
};
/// Type C: the plane of C and C + 180, angles from -180 (towards C + 180) to 180, 0 at gamma = 0.
Cut plane_cut(const Distribution&, double c);
/// Types A and B: along H at a V, and along V at an H.
Cut horizontal_cut(const Distribution&, double v);
Cut vertical_cut(const Distribution&, double h);

/// First and last angle, deg, at which the intensity of a cut is at least `share` of its greatest, linear between
/// nodes. Empty for a dark cut.
struct Width {
    double from = 0, to = 0;
    double angle() const { return to - from; }
};
std::optional<Width> width_of(const Cut&, double share);

enum class BeamSymmetry : uint8_t { None, Rotational, Quadrants, AboutC0, AboutC90, LeftRight };
/// Symmetry that all intensities have within 0.1 % of the greatest. AboutC0: C and -C are alike; LeftRight: H and -H.
BeamSymmetry symmetry_of(const Distribution&);
const char* name_of(BeamSymmetry);

struct BeamFigures {
    double flux = 0;                      ///< lm
    double output_ratio = 0;              ///< flux over that of the lamps; 0 for absolute photometry
    double upward_share = 0;              ///< of the flux, above the horizontal; type C only
    double largest = 0;                   ///< cd
    double largest_h = 0, largest_v = 0;  ///< where: C and gamma, or H and V, deg
    BeamSymmetry symmetry = BeamSymmetry::None;
    /// Greatest intensity at gamma = 70, 80, 90 and from 95 deg up, cd per 1000 lm of `flux`; type C only.
    std::array<double, 4> at_70_80_90_95{};
    /// The strictest of the luminous intensity classes G*1 to G*6 that holds (EN 13201-2:2015, annex A); may be empty.
    std::string glare_class;
};
BeamFigures beam_figures(const Distribution&);

/// A point where UN R112 limits a passing beam of class B, right-hand traffic.
struct BeamPoint {
    const char* name;
    double h, v;         ///< deg, right and up positive
    double least, most;  ///< cd; 0: no such limit
};
std::span<const BeamPoint> passing_beam_points();

}  // namespace vesper::photometry
