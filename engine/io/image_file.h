// Picture files: PNG and JPEG in, PNG and OpenEXR out. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/image.h"

namespace vesper::io {

/// Decodes a PNG, JPEG or, where Vesper was built with libwebp, WebP held in memory to 8-bit RGBA. Throws Error (reason
/// only; the caller adds the place) when it is none of them or damaged, OverLimit when it is larger than `max_side` px
/// in either direction or of more than `max_texels`. 16-bit, palette, grey and CMYK files are converted; colour
/// profiles and gamma chunks are ignored, as glTF demands.
Image decode_image(std::span<const uint8_t> bytes, uint32_t max_side, uint64_t max_texels = UINT64_MAX);

/// A picture of 16 bits per channel: RGBA, rows from the top, not linear.
struct WideImage {
    uint32_t width = 0, height = 0;
    std::vector<uint16_t> rgba;  ///< width * height * 4 codes
};
/// The same for a PNG, with all its bits: codes of fewer are stretched, so that the largest is 65535.
WideImage decode_wide_png(std::span<const uint8_t> bytes, uint32_t max_side, uint64_t max_texels = UINT64_MAX);

/// The media type of a PNG or JPEG ("image/png"), or of another picture format we know but do not read; "" otherwise.
std::string media_type(std::span<const uint8_t> bytes);

/// Whether decode_image reads WebP.
bool reads_webp();

/// Whether a picture is a PNG of 16 bits a channel.
bool is_16_bit_png(std::span<const uint8_t> bytes);

/// What the codes of a picture mean, as its PNG says: code points of ITU-T H.273. Chunk cICP, sRGB for its curve in
/// Rec. 709, none where the transfer is unknown.
struct PngColour {
    uint8_t primaries = 2;  ///< 1: Rec. 709, 9: Rec. 2020, 12: Display P3, 2: others
    uint8_t transfer = 2;   ///< 4: gamma 2.2, 13: sRGB, 16: PQ, 2: others
    bool operator==(const PngColour&) const = default;
};
constexpr PngColour kPngSrgb{1, 13};

/// What chunk cICP of a PNG says; nothing without one, or of what is no PNG.
std::optional<PngColour> stated_colour(std::span<const uint8_t> png);

/// Named texts of a picture: attributes of an OpenEXR header, tEXt chunks of a PNG (ASCII, names of at most 79
/// characters).
using Header = std::vector<std::pair<std::string, std::string>>;

/// Writes 8-bit RGBA (alpha ignored) as an RGB PNG. The file is replaced only when complete. Throws Error.
void write_png(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const uint8_t> rgba,
               PngColour = kPngSrgb, const Header& = {});

/// Writes words of 10 bits a channel, red in the lowest (A2B10G10R10, alpha ignored), as an RGB PNG of 16 bits (chunk
/// sBIT: 10). The file is replaced only when complete. Throws Error.
void write_png_10bit(const std::filesystem::path& file, uint32_t width, uint32_t height,
                     std::span<const uint32_t> words, PngColour, const Header& = {});

/// Writes RGBA float pixels (alpha ignored) as a 32-bit RGB OpenEXR, ZIP compressed, in cd/m^2 (whiteLuminance 1).
/// The file is replaced only when complete. Throws Error.
void write_exr(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const float> rgba,
               const Header& header);

}  // namespace vesper::io
