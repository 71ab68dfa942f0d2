// Counts of the shadow maps that a frame draws. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace vesper::render {

/// The shadow maps of a frame.
struct ShadowReport {
    uint32_t lamps = 0;     ///< with a map
    uint32_t maps = 0;      ///< drawn anew
    uint32_t cached = 0;    ///< taken from the cache, beside these
    uint32_t tiles = 0;     ///< drawn anew, beside those of these maps
    uint32_t deferred = 0;  ///< maps and tiles that are out of date: the budget did not reach them
    uint64_t bytes = 0;     ///< of device memory
    std::string note;       ///< why the cache keeps no more maps, in the frame after which it does not
};

}  // namespace vesper::render
