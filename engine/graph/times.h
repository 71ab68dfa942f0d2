// Times of passes over several frames. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "graph/frame_slot.h"

namespace vesper::graph {

/// Adds the times and bytes of passes to those of the same name; others are appended.
inline void add_times(std::vector<Timing>& to, const std::vector<Timing>& times) {
    for (const Timing& time : times) {
        const auto same = std::ranges::find(to, time.pass, &Timing::pass);
        if (same == to.end()) {
            to.push_back(time);
            continue;
        }
        same->milliseconds += time.milliseconds;
        same->bytes_read += time.bytes_read, same->bytes_written += time.bytes_written;
    }
}

}  // namespace vesper::graph
