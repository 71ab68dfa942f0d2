// Sensitivity of the eye to contrast, and luminance in just noticeable differences. SPDX-License-Identifier: MIT
// Frequencies in cycles per degree of the visual field, luminances in cd/m^2. Contrast of a grating is its amplitude
// over its mean luminance; sensitivity is 1 over the contrast that is seen half of the time.
#pragma once

#include <optional>
#include <vector>

#include "vision/glare.h"

namespace vesper::analysis {

/// Who looks, and at how much of the visual field.
struct ContrastEye {
    double field = 10;  ///< side of the square field, degrees
    double age = 23;    ///< years: thresholds rise by age_factor()
    std::optional<vision::ScatteringEye> scatters =
        {};  ///< pictures are those on its retina, with the light that it scatters
};

/// Barten 1999, "Contrast Sensitivity of the Human Eye and its Effects on Image Quality", equation 3.26, with the
/// constants of ITU-R BT.2246 (typical observer, 0.1 s, both eyes). 0 for frequencies or luminances of 0. Of contrast
/// on the retina it is that over cie_modulation(): what an eye sees does not depend on how its blur is modelled.
double contrast_sensitivity(double frequency, double luminance, const ContrastEye& eye = {});

/// Deg^2 over which an eye sums a grating of so many cycles/degree at most: 1 / (1/X_max^2 + (u/N_max)^2) with a field
/// of 12 degrees and 15 cycles (Barten 1999).
double summation_area(double frequency);

/// The largest over all frequencies.
double peak_sensitivity(double luminance, const ContrastEye& eye = {});

/// Luminance on a scale of just noticeable differences: its slope at L is peak_sensitivity(L) / L (Mantiuk, Daly,
/// Myszkowski and Seidel 2005, with the sensitivity above). A grating of the frequency of the peak is at its threshold
/// if its amplitude is 1 on this scale.
class JndScale {
public:
    static constexpr double kLeast = 1e-6, kMost = 1e9;  ///< cd/m^2: luminances beyond count as these

    explicit JndScale(const ContrastEye& eye);

    double jnd(double luminance) const;   ///< 0 at kLeast; of what is not a number: 0
    double luminance(double jnd) const;   ///< cd/m^2
    double peak(double luminance) const;  ///< peak_sensitivity(), within 0.1 %
    const ContrastEye& eye() const { return eye_; }

private:
    double at(const std::vector<double>& table, double luminance) const;

    ContrastEye eye_;
    std::vector<double> jnds_, peaks_;  // at equal steps of the logarithm of luminance
};

}  // namespace vesper::analysis
