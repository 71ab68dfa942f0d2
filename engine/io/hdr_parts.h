// What the readers of HDR pictures share; not for others. SPDX-License-Identifier: MIT
#pragma once

#include "io/hdr_image.h"
#include "io/primaries.h"

namespace vesper::io::hdr {

/// Applies a matrix to all pixels; the identity leaves them as they are.
void transform(HdrImage&, const glm::dmat3&);

/// Throws Error if a picture of this size is beyond the limits or has no pixels. `what` names it in the message.
void check_size(const char* what, int64_t width, int64_t height, const HdrLimits&);

constexpr uint64_t kMaxFileBytes = uint64_t{1} << 32;

/// Decode a file's bytes. Throw Error, or what OpenEXR throws, with the reason only.
HdrImage decode_exr(std::span<const uint8_t> bytes, const std::string& name, const HdrLimits&,
                    const std::string& layer);
HdrImage decode_radiance(std::span<const uint8_t> bytes, const HdrLimits&);

struct ExrPixels {
    const float* values;  ///< R, G, B of the first pixel
    size_t stride;        ///< from pixel to pixel
    std::string layer;    ///< empty: none
};
struct ExrPicture {
    uint32_t width, height;
    std::vector<ExrPixels> layers;
    double white_luminance;  ///< cd/m^2 of (1, 1, 1); 0: unknown
};
void encode_exr(const std::filesystem::path& file, const ExrPicture&, const Header&);

}  // namespace vesper::io::hdr
