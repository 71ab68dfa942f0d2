// Reflection tables of road surfaces: reduced luminance coefficients towards a driver. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vesper::photometry {

/// An r-table (CIE 144:2001): r = q cos^3(gamma), q = L / E_h, for an observer who looks down at 1 degree. gamma is the
/// angle of incidence from the vertical; beta, in plan, is the turn from "observer to point" to "point to lamp": 0
/// where the lamp stands beyond the point (the specular side), 180 where it stands behind the observer. A cell of 0 is
/// not covered. L = r I / H^2 with H the height of the lamp above the road.
struct ReflectionTable {
    std::string name;
    std::vector<double> tan_gamma;  ///< ascending from 0, at least 2
    std::vector<double> beta;       ///< deg, ascending from 0 to 180, at least 2
    std::vector<double> r;          ///< sr^-1, beta.size() values for each tan_gamma
    double stated_q0 = 0;           ///< the Q0 of the class, sr^-1; 0 if not stated
    bool wet = false;               ///< a wet surface: limits of dry surfaces do not apply
    bool extended = false;          ///< see extended()

    double at(size_t t, size_t b) const { return r[t * beta.size() + b]; }
    bool operator==(const ReflectionTable&) const = default;
};

/// r, sr^-1, bilinear in tan gamma and beta (either sign, any turn). 0 beyond the last tan gamma (see extended()).
double reduced_luminance_coefficient(const ReflectionTable&, double tan_gamma, double beta_deg);
/// q = r / cos^3(gamma) = L / E_h, sr^-1.
double luminance_coefficient(const ReflectionTable&, double tan_gamma, double beta_deg);

/// Q0: the mean of q over the solid angle of the lamps that matter, -4H < x < 12H, |y| < 3H (CIE 144:2001, 5.2), sr^-1.
/// The integral of the bilinear r; it lies 1 to 3 % above the published values of the standard tables, because straight
/// lines between the nodes lie above a lobe.
double average_luminance_coefficient(const ReflectionTable&);
/// Qd = L / E under a sky of uniform luminance, the luminance coefficient in diffuse illumination: the integral of q
/// cos(gamma) over the hemisphere, over pi, sr^-1. Of rho / pi for a Lambert surface.
double diffuse_luminance_coefficient(const ReflectionTable&);
/// S1 = r(tan gamma 2, beta 0) / r(0, 0), how specular the surface is (CIE 144:2001).
double specular_factor(const ReflectionTable&);

/// The same table for a lighter or darker surface: all of r times q0 / stated_q0 (average_luminance_coefficient() where
/// none is stated), so that R3 of Q0 = 0.07 is R3 as published.
ReflectionTable rescaled(ReflectionTable, double q0);

/// The table continued for rendering, without an edge. A cell that is not covered takes q of the nearest covered tan
/// gamma below it in its column. Beyond the last tan gamma L per illuminance on a plane facing the lamp is constant: r
/// falls as cos^2(gamma). Covered cells are unchanged. CIE calculations use the table as it is.
ReflectionTable extended(ReflectionTable);
/// The table with its values at beta = 90 degrees for all beta.
ReflectionTable without_sheen(ReflectionTable);

/// Throws Error (starting with `place`) unless the table has the form above and at most 512 by 512 finite values.
void check_reflection_table(const ReflectionTable&, const std::string& place);

/// Whether a file is an r-table: the corner cell of a CSV file is tan gamma, or it is one for DIALux (.rtb).
bool is_reflection_table(std::span<const uint8_t> text);
/// Parses comma-separated text: comments (#), a row of beta, then rows of tan gamma followed by r x 1e4; an empty field
/// is 0. A comment "# Q0 0.07" states Q0, "# wet" a wet surface. Parses the tables that DIALux imports (.rtb), too.
/// Throws Error naming file, line and reason.
ReflectionTable parse_reflection_table(std::span<const uint8_t> text, const std::string& name);
ReflectionTable read_reflection_table(const std::filesystem::path& file);

/// Names of the tables built in: R1 to R4, C1, C2 (dry), W3, W4 (wet).
std::vector<std::string> standard_reflection_tables();
/// A standard table by name; else a file relative to `folder`.
ReflectionTable find_reflection_table(const std::string& name_or_file, const std::filesystem::path& folder = {});

}  // namespace vesper::photometry
