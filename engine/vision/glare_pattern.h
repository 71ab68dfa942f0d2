// Needles and halo about a lamp: how what is scattered differs from a smooth veil. SPDX-License-Identifier: MIT
// Angles in degrees, functions in sr^-1 of RGB (linear Rec. 709) for white light of 1 lx.
#pragma once

#include <vector>

#include "vision/eye_aperture.h"
#include "vision/glare.h"

namespace vesper {

/// About a lamp in the direction (theta, azimuth) is seen smooth(theta) + ring(theta) + needles(theta) modulation(theta, azimuth), which is
/// nowhere below a tenth of the smooth veil. Rows are rings of growing radius, evenly in its logarithm and as far apart as columns are in azimuth
/// (counted from the right, up), so that a blur is the same in both.
struct GlarePattern {
    static constexpr int kColumns = 512, kRows = 448;
    static constexpr int kReach = 6;             ///< degrees: the outer edge of the last row; there is nothing beyond
    static double angle(double row);             ///< in degrees; whole numbers are the inner edges of rows, halves their middles
    static double row_of(double degrees);        ///< its inverse

    std::vector<glm::vec3> ring, needles;        ///< of each row's middle
    std::vector<glm::vec3> modulation;           ///< row by row: of mean 0 in each row and channel, at least -1
};

/// Temporal glare (Ritschel et al. 2009): the far field of an aperture behind a pupil of `diameter` mm, over its azimuthal mean, each wavelength at
/// its own scale. The mean stays that of `smooth` in luminance, at every angle, and in the light of every channel; the halo is its colours,
/// in a pupil wider than 3 mm.
GlarePattern temporal_pattern(const EyeScatter& smooth, const EyeAperture&, double diameter, double seconds);

/// Spencer et al. 1995: the ciliary corona f1 as radial needles of random intensity, and the lenticular halo f3 of the state, in colours.
/// `smooth` is that of spencer_veil.
GlarePattern spencer_pattern(const EyeScatter& smooth, SpencerState, uint32_t seed);

/// What is smooth in Spencer's function of a state: its core, corona and bloom; and as much light as the halo has, without a ring: where
/// the pattern is not drawn, for lamps too dim for it.
double spencer_veil(double theta, SpencerState);

/// Part of the light that the halo has behind a pupil, mm: 0 up to 3, and from there linearly to Spencer's 0.033 of a scotopic eye (4.9 mm);
/// his mesopic eye has 0.016.
double halo_share(double diameter);

}  // namespace vesper
