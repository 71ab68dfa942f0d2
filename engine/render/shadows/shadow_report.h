// Counts of the shadow maps that a frame draws. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace vesper::render {

/// The shadow maps of a frame.
struct ShadowReport {
    uint32_t lamps = 0;   ///< with a map
    uint32_t maps = 0;    ///< drawn anew
    uint32_t cached = 0;  ///< taken from the cache, beside these
    uint32_t bodies = 0;  ///< placements that move, drawn into maps of lamps that do not, over what stands still
    uint64_t bytes = 0;   ///< of device memory, with what maps are drawn with, which other passes of a frame share
    std::string note;     ///< why the cache keeps no more maps, in the frame after which it does not
};

}  // namespace vesper::render
