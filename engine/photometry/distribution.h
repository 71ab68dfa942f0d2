// Luminous intensity over directions, from an IES, EULUMDAT or headlamp file. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::photometry {

/// Meaning of the two angles of a distribution. The luminaire's frame is that of a glTF node with a lamp
/// (EXT_lights_ies): the point (0, 0) of the measurement is along -Z. intensity() has the axes.
enum class Goniometry : uint8_t {
    CGamma,  ///< type C: C about the vertical axis, gamma from the nadir (CIE 121, LM-63 type 1)
    TypeB,   ///< polar axis horizontal: d = (sin H, cos H sin V, cos H cos V) to the right, up, forward (LM-63 type 2)
    TypeA    ///< polar axis vertical: d = (cos V sin H, sin V, cos V cos H) (LM-63 type 3; headlamps, UN R112)
};

/// Luminous opening, m. Zero if the file does not state it.
struct LuminousOpening {
    double length = 0;  ///< along C0-C180; left to right of a headlamp
    double width = 0;   ///< along C90-C270; top to bottom of a headlamp
    double height = 0;
    bool round = false;  ///< an ellipse of these diameters
    bool drawn =
        true;  ///< false: the scene has a surface that shows the lamp; the opening has a size for shadows alone
    /// Area of the opening seen against the main direction, m^2; 0 where unknown.
    double area() const;
};

/// Intensities at all pairs of two ascending lists of angles. Symmetry is expanded: C runs from 0 to 360 with both ends
/// present (equal to one another), or is the one angle 0 when the distribution has rotational symmetry; B and A keep
/// the ranges of their file. Between the angles intensity is bilinear in degrees, outside them it is 0.
struct Distribution {
    std::string name;  ///< of the luminaire, or of the file
    Goniometry goniometry = Goniometry::CGamma;
    std::vector<double> horizontal;  ///< C or H, deg
    std::vector<double> vertical;    ///< gamma or V, deg
    std::vector<double> candela;     ///< cd, vertical.size() values for each horizontal angle, >= 0 and finite
    double lamp_flux = 0;            ///< of the bare lamps the intensities refer to, lm; 0: absolute photometry
    LuminousOpening opening;
    std::vector<std::pair<std::string, std::string>> metadata;  ///< keywords and texts of the file, in its order
    std::vector<std::string> notes{};  ///< of its reader: what was assumed where readers of such files disagree

    double at(size_t h, size_t v) const { return candela[h * vertical.size() + v]; }
};

/// Intensity in a direction of the luminaire's frame, cd; of any length. Type C: x = sin g cos C, y = sin g sin C, z =
/// -cos g, so that gamma = 0 is -Z, C = 0 is +X and C = 90 is +Y. Types A and B: right is +X, up is +Y, forward is -Z.
double intensity(const Distribution&, glm::dvec3 direction);

/// The integral of the bilinear intensity over all directions, lm: exact in one angle, by parts in the other.
double luminous_flux(const Distribution&);

/// The largest tabulated intensity, cd.
double largest_intensity(const Distribution&);

/// Left and right exchanged (x to -x): H to -H, C to 180 - C. Turns a beam for right-hand traffic into one for
/// left-hand.
Distribution mirrored(const Distribution&);

/// Reads a distribution from a file: .ies (LM-63), .ldt (EULUMDAT), .csv or .exr (a laboratory's grid, grid.h); any
/// other name by its contents. Throws Error naming file, line and reason.
Distribution read_distribution(const std::filesystem::path& file);

}  // namespace vesper::photometry
