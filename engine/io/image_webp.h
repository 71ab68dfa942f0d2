// WebP pictures, and the limits that every picture keeps. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "base/image.h"

namespace vesper::io {

/// Why a picture of this size in px is over the limits, as "picture of 5 x 7 px" goes on; null where it is not.
const char* over_limit(uint64_t width, uint64_t height, uint32_t max_side, uint64_t max_texels);

/// decode_image for WebP. Throws Error where reads_webp() is false.
Image decode_webp(std::span<const uint8_t> bytes, uint32_t max_side, uint64_t max_texels);

}  // namespace vesper::io
