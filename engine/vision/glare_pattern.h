// Needles and halo around a lamp: the difference of scattered light from a smooth veil. SPDX-License-Identifier: MIT
// Angles in degrees, functions in sr^-1 of RGB (linear Rec. 709) for white light of 1 lx.
#pragma once

#include <vector>

#include "vision/eye_aperture.h"
#include "vision/glare.h"

namespace vesper::vision {

/// Light in the direction (theta, azimuth) from a lamp: smooth(theta) + ring(theta) + needles(theta) modulation(theta,
/// azimuth), at least a tenth of the smooth veil. Rows are rings, evenly spaced in the logarithm of their radius.
/// Columns are azimuths, counted from the right upwards, at the same spacing, so that a blur is the same in both.
struct GlarePattern {
    static constexpr int kColumns = 512, kRows = 448;
    static constexpr int kReach = 6;       ///< degrees: outer edge of the last row and of the pattern
    static double angle(double row);       ///< degrees of a row; whole numbers are inner edges, halves are
                                           ///< middles
    static double row_of(double degrees);  ///< its inverse

    std::vector<glm::vec3> ring, needles;  ///< of each row's middle
    std::vector<glm::vec3> modulation;     ///< row by row; mean 0 in each row and channel, at least -1
};

/// Temporal glare (Ritschel et al. 2009): the far field of an aperture behind a pupil of `diameter` mm, over its
/// azimuthal mean, each wavelength at its own scale. The mean stays that of `smooth` in luminance, at every angle, and
/// in the light of every channel; the halo is its colours, in a pupil wider than 3 mm.
GlarePattern temporal_pattern(const EyeScatter& smooth, const EyeAperture&, double diameter, double seconds);

/// Spencer et al. 1995: the ciliary corona f1 as radial needles of random intensity, and the lenticular halo f3 of the
/// state, in colours. `smooth` is that of spencer_veil.
GlarePattern spencer_pattern(const EyeScatter& smooth, SpencerState, uint32_t seed);

/// The smooth part of Spencer's function: core, corona, bloom, and the light of the halo without a ring, for lamps that
/// are too dim for a pattern.
double spencer_veil(double theta, SpencerState);

/// Share of the halo in the light behind a pupil of `diameter` mm: 0 up to 3 mm, and from there linearly to Spencer's
/// 0.033 of a scotopic eye (4.9 mm); his mesopic eye has 0.016.
double halo_share(double diameter);

}  // namespace vesper::vision
