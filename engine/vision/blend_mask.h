// How much light each pixel of a projector gives where pictures overlap. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vesper::vision {

/// Factors of light for the pixels of a projector's picture.
struct BlendMask {
    std::string name;                ///< of its file, for messages
    uint32_t width = 0, height = 0;  ///< px
    std::vector<float> factors;      ///< 0 to 1, linear in light, row by row from the top
};

constexpr uint64_t kMaxBlendMaskBytes = 256u << 20;
constexpr uint32_t kMaxBlendMaskSide = 16384;  ///< px
constexpr uint64_t kMaxBlendMaskPixels = uint64_t{1} << 26;

/// Reads a grey PNG, or one of three equal channels: its largest code is 1, and codes are linear in light whatever the
/// file says of them. Throws Error, naming file and reason, for other files, colours and pixels that can be seen
/// through.
BlendMask read_blend_mask(const std::filesystem::path& file);

}  // namespace vesper::vision
