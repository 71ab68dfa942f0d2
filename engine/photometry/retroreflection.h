// Retroreflective sheets and road markings. SPDX-License-Identifier: MIT
// R_A = I / (E A), cd/(lx m^2) (CIE e-ILV 17-24-103): a sheet seen at the angle nu from its normal has the luminance
// L = R_A E / cos(nu). Markings: R_L = L / E (EN 1436). E is always the illuminance facing the lamp.
#pragma once

#include <string>
#include <vector>

namespace vesper::photometry {

constexpr size_t kMaxRetroNodes = 8;  ///< of either angle

/// A coefficient of retroreflection over the observation angle (at the target, between lamp and eye) and the entrance
/// angle (between lamp and normal). Its logarithm is linear between observation angles, constant before the first and
/// continues its slope beyond the last; the factor for the entrance is linear in its cosine, constant beyond both ends.
struct Retroreflector {
    std::string name;
    std::vector<double> observation;      ///< degrees, ascending, at least two
    std::vector<double> coefficient;      ///< at the first entrance angle and where the base colour is 1, > 0; falls at
                                          ///< the end
    std::vector<double> entrance;         ///< degrees, ascending, at least one
    std::vector<double> entrance_factor;  ///< [0, 1]
    bool marking = false;                 ///< R_L rather than R_A
    bool operator==(const Retroreflector&) const = default;
};

/// "RA1", "RA2" (least values of new white sheets, EN 12899-1), "prismatic" and "RA3" (the same: ASTM D4956 type XI).
/// Throws Error (reason only) for other names.
Retroreflector retroreflective_class(const std::string& name);
/// A road marking of a coefficient of retroreflected luminance, mcd/(m^2 lx), at the 30 m geometry of EN 1436.
Retroreflector retroreflective_marking(double r_l_mcd);
/// All coefficients times a factor.
Retroreflector rescaled(Retroreflector, double factor);
/// Throws Error (reason only) unless the rules above hold.
void check_retroreflector(const Retroreflector&);

/// R_A or R_L, cd/(lx m^2), at angles in degrees.
double retroreflection(const Retroreflector&, double observation, double entrance);
/// Luminance, cd/m^2, of a surface lit with `illuminance` (lx, facing the lamp) and seen `view` degrees from its
/// normal. cos(view) counts as at least 0.05.
double retroreflected_luminance(const Retroreflector&, double observation, double entrance, double view,
                                double illuminance);

}  // namespace vesper::photometry
