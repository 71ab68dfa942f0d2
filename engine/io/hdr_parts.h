// What the readers of HDR pictures share; not for others. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "io/hdr_image.h"

namespace vesper::hdr {

/// CIE xy chromaticities of the primaries and of white.
struct Primaries {
    glm::dvec2 red, green, blue, white;
};
constexpr Primaries kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
constexpr Primaries kXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};

/// Colours of these primaries as Rec. 709: the same X, Y and Z, with Y(1, 1, 1) = 1 on both sides (SMPTE RP 177).
/// Throws Error if the primaries span no volume.
glm::dmat3 to_rec709(const Primaries&);

/// Applies a matrix to all pixels; the identity leaves them as they are.
void transform(HdrImage&, const glm::dmat3&);

/// Throws Error if a picture of this size is beyond the limits or has no pixels. `what` names it in the message.
void check_size(const char* what, int64_t width, int64_t height, const HdrLimits&);

constexpr uint64_t kMaxFileBytes = uint64_t{1} << 32;

/// Decode a file's bytes. Throw Error, or what OpenEXR throws, with the reason only.
HdrImage decode_exr(std::span<const uint8_t> bytes, const std::string& name, const HdrLimits&);
HdrImage decode_radiance(std::span<const uint8_t> bytes, const HdrLimits&);

struct ExrPixels {
    uint32_t width, height;
    const float* values;     ///< R, G, B of the first pixel
    size_t stride;           ///< from pixel to pixel
    double white_luminance;  ///< cd/m^2 of (1, 1, 1); 0: unknown
};
void encode_exr(const std::filesystem::path& file, const ExrPixels&, const Header&);

}  // namespace vesper::hdr
