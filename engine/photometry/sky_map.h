// A sky made ready for shading: direct, blurred by specular lobes, and as illuminance. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "photometry/environment.h"

namespace vesper::photometry {

/// A map of all directions on a square (Q. Meyer et al., "On Floating-Point Normal Vectors", 2010; z is the pole), with
/// a border of one texel that repeats what lies beyond the edge, so that bilinear lookups need no wrapping.
struct OctahedralMap {
    uint32_t side = 0;              ///< texels without the border
    std::vector<glm::vec4> texels;  ///< (side + 2)^2, cd/m^2 RGB

    uint32_t pitch() const { return side + 2; }
};

constexpr uint32_t kSkyLobes = 5;       ///< blurred maps: roughness 1/5, 2/5, ... 1
constexpr uint32_t kSkyLobeSide = 64;   ///< their side, texels of about 3 degrees
constexpr uint32_t kSkyMaxSide = 1024;  ///< of the sharp map
constexpr uint32_t kSpecularSide = 32;  ///< of the table of reflected fractions

/// The sky itself.
struct SkyMap {
    Irradiance9 irradiance{};
    OctahedralMap sharp;               ///< as seen; the reflection of roughness 0
    std::vector<OctahedralMap> lobes;  ///< mean luminance in the GGX lobe of each roughness about a direction of
                                       ///< reflection
};
/// Lobes for light, eye and normal in one line (B. Karis, "Real Shading in Unreal Engine 4", 2013), weighted by the
/// cosine, so a uniform sky is unchanged. At grazing incidence true lobes are longer.
SkyMap make_sky_map(const Environment&);

/// Direction of a place on the square [-1, 1]^2, and its inverse.
glm::dvec3 octahedral_direction(glm::dvec2 place);
glm::dvec2 octahedral_place(glm::dvec3 direction);
/// Luminance in a direction, cd/m^2 RGB, bilinear between texels.
glm::dvec3 luminance_of(const OctahedralMap&, glm::dvec3 direction);

/// Fractions of uniform light that a rough surface reflects: `scale` F0 + `offset` F90 (Karis 2013), F Schlick's. GGX
/// with height-correlated Smith masking (Heitz 2014). By importance sampling with `samples` directions.
struct Reflected {
    double scale = 0, offset = 0;
};
Reflected specular_reflectance(double normal_eye, double roughness, uint32_t samples);
/// kSpecularSide^2 values; the root of normal_eye from 0 to 1 along rows, roughness from 0 to 1 down columns, both ends
/// included. Bilinear lookups are within 0.008 where normal_eye is at least 0.02.
std::vector<Reflected> specular_table();

}  // namespace vesper::photometry
