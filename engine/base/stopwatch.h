// Time on the host's clock. SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <utility>

namespace vesper {

/// Runs from when it is made.
class Stopwatch {
public:
    /// Since the start or the last lap, ms.
    double milliseconds() const { return std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }
    /// The same, and starts the next lap.
    double lap() {
        const Clock::time_point now = Clock::now();
        return std::chrono::duration<double, std::milli>(now - std::exchange(start_, now)).count();
    }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace vesper
