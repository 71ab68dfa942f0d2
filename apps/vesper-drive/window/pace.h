// How fast pictures come in a window. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "render/setting.h"

namespace vesper::drive {

/// Takes the mean rate of pictures over stretches of time, and says which set of --quality would help.
class Pace {
public:
    static constexpr double kSlow = 20;    ///< pictures a second; fewer are slow
    static constexpr double kCrawl = 4;    ///< pictures a second; with fewer nobody drives
    static constexpr double kStretch = 2;  ///< s of which a mean is taken

    /// A picture came so many seconds after the one before.
    void add(double seconds);
    /// The time of the next picture, which makes things ready, does not count, nor do those before.
    void restart() { *this = {}; }
    /// Whether the last whole stretch was slow.
    bool is_slow() const { return slow_; }
    bool crawls() const { return crawls_; }
    /// The next faster set where pictures are slow; none where there is none.
    std::optional<render::Quality> offer(render::Quality now) const;

private:
    bool begun_ = false, slow_ = false, crawls_ = false;
    double seconds_ = 0;
    uint64_t pictures_ = 0;
};

}  // namespace vesper::drive
