// Light scattered in the eye: published point spread functions. SPDX-License-Identifier: MIT
// Angles theta in degrees from the source, ages in years, values in sr^-1: cd/m^2 of veil per lx at the eye.
#pragma once

#include <functional>
#include <vector>

namespace vesper::vision {

/// Age and iris of the scattering eye. Pigmentation of the iris: 0 very dark, 0.5 brown, 1 green, 1.2 light blue (CIE
/// 135/1-6, 1999).
struct ScatteringEye {
    double age = 35;
    double pigmentation = 0.5;
    bool operator==(const ScatteringEye&) const = default;
};

/// CIE total glare function (Vos and van den Berg, CIE 135/1, 1999): all angles up to 90 degrees, the core included.
double cie_total_glare(double theta, const ScatteringEye& = {});
/// What that leaves of the contrast of a grating, of a frequency in cycles/degree from 0.05 on: the Hankel transform of
/// the function for small angles. What it scatters evenly over the field of view is lost to gratings of all
/// frequencies.
double cie_modulation(double frequency, const ScatteringEye& = {});
/// CIE general disability glare equation (CIE 146:2002): 0.1 to 100 degrees.
double cie_general_glare(double theta, const ScatteringEye& = {});
/// CIE small angle equation (the same): 0.1 to 30 degrees.
double cie_small_angle_glare(double theta, double age = 35);
/// CIE age-adjusted Stiles-Holladay equation (the same): 1 to 30 degrees.
double cie_age_adjusted_glare(double theta, double age = 35);
/// EN 13201-3:2015, 8.5: 9.86 (1 + (age/66.4)^4) / theta^2 above 1.5 and up to 60 degrees, 10/theta^3 + 5/theta^2 (1 +
/// (age/62.5)^4) from 0.1 degrees on; otherwise 0.
double en13201_glare(double theta, double age);
/// TI of a veil, %: 65 Lv / Lav^0.8, above 5 cd/m^2 95 Lv / Lav^1.05 (CIE 140; EN 13201-3, 8.5). Luminances in cd/m^2.
double threshold_increment(double veil, double average_luminance);

/// The parts of Spencer, Shirley, Zimmerman and Greenberg 1995, each of which integrates to 1 over the hemisphere.
double spencer_core(double theta);                           ///< f0: unscattered light
double spencer_corona(double theta);                         ///< f1: the ciliary corona, seen as needles
double spencer_bloom(double theta);                          ///< f2
double spencer_halo(double theta, double nanometres = 568);  ///< f3: lenticular halo, a ring at 3 degrees times nm /
                                                             ///< 568

/// State of adaptation: the pupil limits the light through the fibres at the edge of the lens.
enum class SpencerState : unsigned char { Photopic, Mesopic, Scotopic };
struct SpencerWeights {
    double core, corona, bloom, halo;
};
SpencerWeights spencer_weights(SpencerState);
/// Sum of the weighted parts without the halo, which has colours.
double spencer_smooth_glare(double theta, const SpencerWeights&);
/// Sum of all weighted parts.
double spencer_glare(double theta, SpencerState, double nanometres = 568);

/// Ward Larson, Rushmeier and Piatko 1997 (their program: `pcond -v`): 0.92 stays and 0.08 is scattered as cos(theta) /
/// theta^2 from half a degree on, the radius of the fovea, and evenly within it. Integrates to 1.
double ward_veil(double theta);

/// A point spread function about its axis, scaled to integrate to 1 over the hemisphere: it moves light and makes none.
class EyeScatter {
public:
    /// `psf` in sr^-1 of theta in degrees, positive, without features narrower than a sixteenth of their angle.
    explicit EyeScatter(std::function<double(double)> psf);

    /// sr^-1.
    double operator()(double theta) const { return scale_ * psf_(theta); }
    /// Part of the light within `theta` of the source.
    double within(double theta) const { return scale_ * integral(theta); }
    /// Integral of the unscaled function over the hemisphere.
    double total() const { return 1 / scale_; }

private:
    double integral(double theta) const;
    std::function<double(double)> psf_;
    std::vector<double> angles_, sums_;  // sums_[i]: the integral up to angles_[i]
    double scale_ = 1;
};

}  // namespace vesper::vision
