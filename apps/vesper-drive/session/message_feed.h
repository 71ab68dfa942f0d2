// A simulator that sends its messages while one drives. SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "external/stationary.h"
#include "osi/receiver.h"
#include "osi/sender_clock.h"
#include "osi/unit_check.h"
#include "session/session.h"

namespace vesper::drive {

/// Hands what a Receiver hears to a session, and says which moment is shown.
class MessageFeed {
public:
    using Clock = std::chrono::steady_clock;

    /// `delay`: of what is shown behind what is heard, s.
    MessageFeed(const osi::Address&, double delay);

    /// In a window: takes what came, without waiting.
    void listen(Session&);
    /// The moment that is shown at that time; none before the first message.
    std::optional<double> shown(Clock::time_point);
    /// Without a window: waits until messages go beyond that moment by the delay. False where the sender has been
    /// silent for 5 s and has not reached it; the first message is waited for as long as `first`, s.
    bool wait_for(Session&, double moment, double first);

    osi::StreamCounts counts() const;
    /// "1204 messages, 3 late, 1 malformed (the last malformed one has no timestamp)".
    std::string report() const;
    /// Why the sender's angles or lengths may not be those of OSI.
    std::vector<std::string> doubts() const { return units_.doubts(); }
    std::string place() const;  ///< where it listens

private:
    bool hear(Session&, std::chrono::milliseconds longest);

    osi::Receiver receiver_;
    std::string host_;
    double delay_;
    osi::SenderClock clock_;
    std::optional<int64_t> first_;  // time of the first message, ns
    StationaryCensus standing_;
    osi::UnitCheck units_;
    bool objects_ = false;  // that move were in a message
    uint64_t late_ = 0, repeated_ = 0, crowded_out_ = 0;
    bool begun_ = false, silent_ = false, weather_ = false;
    Clock::time_point heard_ = Clock::now(), began_ = Clock::now();
};

}  // namespace vesper::drive
