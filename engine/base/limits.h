// How much files may ask for. SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/error.h"

namespace vesper {

/// A standard limit times the factor in the environment's VESPER_LIMITS, 0.001 to 16 (beyond, indices of 32 bits would
/// not do); without one the limit itself. Throws Error where that is no such number.
inline uint64_t scaled_limit(uint64_t standard) {
    const char* text = std::getenv("VESPER_LIMITS");
    if (!text || !*text) return standard;
    double factor = 0;
    const char* end = text + std::strlen(text);
    const auto parsed = std::from_chars(text, end, factor);
    if (parsed.ec != std::errc() || parsed.ptr != end || !(factor >= 0.001 && factor <= 16))
        throw Error("VESPER_LIMITS: a factor of 0.001 to 16 is expected");
    return static_cast<uint64_t>(factor * static_cast<double>(standard));
}

}  // namespace vesper
