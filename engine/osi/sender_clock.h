// Which moment of a sender is shown now. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace vesper::osi {

/// Estimates from the arrivals of messages how the sender's time runs against ours, also where it is slower or faster
/// or stops. What is shown is behind that by a delay that covers the jitter of arrivals. Times in s.
class SenderClock {
public:
    explicit SenderClock(double delay) : delay_(delay) {}

    /// A message of the sender's `time` arrived `now`.
    void hear(double time, double now);
    /// The sender's time that is shown `now`: never back, never beyond the latest message. None before the first.
    std::optional<double> shown(double now);

private:
    double at(double now) const { return base_ + rate_ * (now - heard_); }

    double delay_;
    bool begun_ = false;
    double base_ = 0, rate_ = 1, heard_ = 0;  // the sender's time was `base_` when it was `heard_`
    double latest_ = 0;
    std::optional<double> shown_;
};

}  // namespace vesper::osi
