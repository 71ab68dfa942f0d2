#include "osi/sender_clock.h"

#include <algorithm>
#include <cmath>

namespace vesper::osi {
namespace {

// An alpha-beta filter (Kalata 1984): shares of an error that correct time and rate. Beyond kLost the sender was
// stopped, or has jumped.
constexpr double kTimeShare = 0.1, kRateShare = 0.005, kLost = 0.5, kFastest = 4;

}  // namespace

void SenderClock::hear(double time, double now) {
    const double error = time - at(now), span = now - heard_;
    if (!begun_ || std::abs(error) > kLost) {
        base_ = time, heard_ = now, rate_ = begun_ ? rate_ : 1, begun_ = true;
    } else if (span > 0) {
        base_ = at(now) + kTimeShare * error;
        rate_ = std::clamp(rate_ + kRateShare * error / std::max(span, 0.01), 0.0, kFastest);
        heard_ = now;
    }
    latest_ = std::max(latest_, time);
}

std::optional<double> SenderClock::shown(double now) {
    if (!begun_) return std::nullopt;
    const double wanted = std::min(at(now) - delay_, latest_);
    shown_ = std::max(shown_.value_or(wanted), wanted);
    return shown_;
}

}  // namespace vesper::osi
