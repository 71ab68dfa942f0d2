// Messages of OSI in UDP datagrams. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vesper::osi {

/// What came, and what of it could not be used.
struct StreamCounts {
    uint64_t messages = 0;    ///< that are whole and can be read
    uint64_t malformed = 0;   ///< that cannot be read
    uint64_t incomplete = 0;  ///< of which a packet was lost, or came in another order
    uint64_t foreign = 0;     ///< datagrams of a second sender
    uint64_t astray = 0;      ///< messages with a time far from those around them
    uint64_t late = 0;        ///< messages before what was shown already
    uint64_t repeated = 0;
    uint64_t crowded_out = 0;  ///< messages that came faster than they were taken
    uint64_t restarts = 0;     ///< of the sender, whose time began again
    bool operator==(const StreamCounts&) const = default;

    /// That could not be used, in all.
    uint64_t unusable() const { return malformed + incomplete + foreign + astray + late + repeated + crowded_out; }
};

/// Puts messages together. A datagram is either a whole message, or a packet of esmini: counter (int32), bytes of the
/// rest (uint32), both with the low byte first, and that rest. Packets of a message count from 1; the last has its
/// counter negative.
class DatagramReader {
public:
    /// The message that this datagram completes.
    std::optional<std::vector<uint8_t>> take(std::span<const uint8_t> datagram);
    uint64_t incomplete() const { return incomplete_; }

private:
    void drop();

    std::vector<uint8_t> parts_;
    int32_t next_ = 1;    // counter of the packet that comes next
    bool skips_ = false;  // the rest of a message of which something is missing
    uint64_t incomplete_ = 0;
};

}  // namespace vesper::osi
