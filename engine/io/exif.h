// What a camera wrote about the exposure of a picture. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace vesper::io {

/// Positive and finite where present.
struct CameraExposure {
    std::optional<double> seconds;   ///< ExposureTime, or 2^-ShutterSpeedValue (APEX)
    std::optional<double> f_number;  ///< FNumber, or 2^(ApertureValue / 2); unknown lenses have none
    std::optional<double> iso;       ///< ISOSpeedRatings
};

/// From the Exif data of a JPEG held in memory; nothing where there is none or it is damaged.
CameraExposure read_exif(std::span<const uint8_t> bytes);

}  // namespace vesper::io
