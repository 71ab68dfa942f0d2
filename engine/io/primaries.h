// Primaries of pictures and displays. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <utility>

#include <glm/glm.hpp>

namespace vesper::io {

/// CIE 1931 xy chromaticities of the primaries and of white.
struct Primaries {
    glm::dvec2 red, green, blue, white;
    bool operator==(const Primaries&) const = default;
};
constexpr Primaries kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
constexpr Primaries kDisplayP3{
    {0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}};  ///< SMPTE EG 432-1, D65
constexpr Primaries kRec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}};
constexpr Primaries kRadiance{{0.640, 0.330},
                              {0.290, 0.600},
                              {0.150, 0.060},
                              {1.0 / 3, 1.0 / 3}};  ///< of Radiance's programs (src/common/color.h)
constexpr Primaries kXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};
/// As files and commands call them.
constexpr std::array<std::pair<const char*, Primaries>, 3> kPrimariesNames{
    {{"rec709", kRec709}, {"p3", kDisplayP3}, {"rec2020", kRec2020}}};

/// Whether white lies inside the triangle of the primaries, so that they can make it.
bool make_white(const Primaries&);

/// Colours of these primaries as Rec. 709: the same X, Y and Z, with Y(1, 1, 1) = 1 on both sides (SMPTE RP 177). No
/// adaptation to white. Throws Error if the primaries span no volume.
glm::dmat3 to_rec709(const Primaries&);

}  // namespace vesper::io
