// Vision of an adapted eye: thresholds over luminance, acuity, pupils. SPDX-License-Identifier: MIT
// Pure functions in double, without a device. Luminance L in cd/m^2; l stands for log10 L.
#pragma once

namespace vesper::vision {

/// Break points of the threshold curves. The published ones leave steps of 0.003 (cones) and 0.012 (rods) log units;
/// the continuous ones do not.
struct ThresholdBreaks {
    double cones = 1.9;   ///< log10 L from which Weber's law holds
    double rods = -1.44;  ///< likewise, log10 of scotopic L

    static constexpr ThresholdBreaks published() { return {}; }
    static constexpr ThresholdBreaks continuous() { return {1.91760, -1.205}; }
    bool operator==(const ThresholdBreaks&) const = default;
};

/// Threshold versus intensity of the cones, cd/m^2 (Ferwerda, Pattanaik, Shirley and Greenberg 1996).
double cone_threshold(double luminance, ThresholdBreaks breaks = ThresholdBreaks::published());
/// Threshold versus intensity of the rods, scotopic cd/m^2 (the same).
double rod_threshold(double luminance, ThresholdBreaks breaks = ThresholdBreaks::published());
/// Both together, as Ward Larson, Rushmeier and Piatko 1997 merge them (and Radiance has it): rods below
/// 10^-0.0184 cd/m^2, cones above; not below 1.38e-3 cd/m^2. With continuous breaks: the lower of the two.
double human_threshold(double luminance, ThresholdBreaks breaks = ThresholdBreaks::published());

/// Scotopic luminance, scotopic cd/m^2, of light of which only X, Y and Z are known, Y in cd/m^2: Y (1.33 (1 + (Y + Z)
/// / X) - 1.68), not below 0 (Ward Larson, Rushmeier and Piatko 1997). Good for broad spectra: 2.57 of daylight white
/// (D65), 1.29 of incandescent light (A; its spectrum has 1.41).
double scotopic_luminance(double x, double y, double z);

/// Diameter of the pupil, mm (Moon and Spencer 1944), as common programs have it.
double pupil_moon_spencer(double luminance);
/// Diameter of the pupil, mm (Watson and Yellott 2012), of a field of `degrees2` square degrees.
double pupil_watson_yellott(double luminance, double degrees2, double age = 28.58, bool two_eyes = true);
/// Retinal illuminance of a luminance seen through a pupil of `diameter` mm, td.
double trolands(double luminance, double diameter);
/// Through the pupil of Moon and Spencer, td.
double trolands(double luminance);

/// Highest frequency seen at full contrast by an eye adapted to a luminance, cycles/degree (Ward et al. 1997, after
/// Shlaer 1937).
double acuity(double luminance);

/// Factor of age on thresholds (Adrian 1989): 1 up to 23 years, 1.93 at 64, 4.3 at 75 and more.
double age_factor(double years);

}  // namespace vesper::vision
