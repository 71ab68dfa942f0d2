// Pictures of high dynamic range: OpenEXR and Radiance in, OpenEXR out. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/limits.h"
#include "io/image_file.h"

namespace vesper::io {

/// A picture in linear Rec. 709 colour. Values are those of the file: it may hold NaN, infinities and negative numbers
/// (colours outside the gamut, ringing of a filter); who computes with them has to clean them.
struct HdrImage {
    uint32_t width = 0, height = 0;
    std::vector<float> rgb;  ///< rows from the top, 3 values per pixel
    double white_luminance =
        0;          ///< cd/m^2 of (1, 1, 1) if the file says (OpenEXR's whiteLuminance; ours say 1; XYZE: 1); else 0
    Header header;  ///< texts and numbers of the file's header, in its order
    double exposure = 1;             ///< of a Radiance file: what its values were multiplied by, and are not any more
    std::vector<std::string> notes;  ///< what of the header makes no sense and was passed over, one line each
};

/// What a picture may cost. Its pixels follow VESPER_LIMITS (base/limits.h).
struct HdrLimits {
    uint32_t max_side = 32768;
    uint64_t max_pixels = scaled_limit(uint64_t{1} << 28);  ///< of 12 bytes each
};

/// Reads an OpenEXR picture of any compression that the OpenEXR library it is built with knows, in scan lines or tiles
/// (the largest level), of half, float or integer values; channels R, G, B (missing ones are 0), or Y (grey), or Y, RY,
/// BY (chroma of every pixel or of one in two), or X, Y, Z in no layer and no named part (CIE 1931; there they are
/// normals or places). Channels named r, g, b, y, red, green, blue or luminance in letters of any case are read as
/// well, where no standard name says otherwise. `layer` names a part, or a layer (channels LAYER.R and so on); without
/// it those of the first part that are in no layer are read, or the only picture there is. Deep pictures are refused.
/// The result covers the display window and is 0 outside of the data window. Other primaries (attribute chromaticities)
/// become Rec. 709 of the same tristimulus values: no adaptation to white. Alpha is ignored. Throws Error with file and
/// reason.
HdrImage read_exr(const std::filesystem::path& file, const HdrLimits& = {}, const std::string& layer = {});

/// Reads a Radiance picture (RGBE or XYZE, run-length coded or not, in any of the eight orders of pixels). EXPOSURE is
/// divided out, so that pictures of one series agree; an EXPOSURE or COLORCORR that is not positive, which some
/// programs write for "I do not know", is noted and left out; PRIMARIES become Rec. 709, and so do Radiance's own where
/// there are none in a picture that one of its programs made (its header has their command, VIEW or SOFTWARE): green
/// and blue weigh 0.670 and 0.065 in luminance there, not 0.715 and 0.072. A mantissa m stands for m + 1/2, as in
/// Radiance.
HdrImage read_radiance(const std::filesystem::path& file, const HdrLimits& = {});

/// Reads either kind, told apart by content.
HdrImage read_hdr_image(const std::filesystem::path& file, const HdrLimits& = {}, const std::string& layer = {});
/// The same from the bytes of a file; `name` begins the messages.
HdrImage decode_hdr_image(std::span<const uint8_t> bytes, const std::string& name, const HdrLimits& = {});

/// Writes 32-bit RGB OpenEXR with the image's header texts, and whiteLuminance if it is known. The file is replaced
/// only when complete. Throws Error.
void write_exr(const std::filesystem::path& file, const HdrImage&);

/// Pictures of one size in one file, 3 values per pixel: channels NAME.R, NAME.G and NAME.B, without a name R, G and B.
struct ExrLayerPixels {
    std::string name;
    std::span<const float> rgb;
};
/// Writes them as write_exr does, without whiteLuminance: what they hold is for the header to say.
void write_exr_layers(const std::filesystem::path& file, uint32_t width, uint32_t height,
                      std::span<const ExrLayerPixels> layers, const Header& header);

}  // namespace vesper::io
