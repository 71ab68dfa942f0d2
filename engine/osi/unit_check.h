// Whether a sender means other angles and lengths than OSI does. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "osi/message.h"

namespace vesper::osi {

/// Compares yaw with the direction in which objects move, and sizes and speeds with those of cars. A yaw counts if it
/// is that direction, within 20 degrees, by one way to read it alone; objects count that move on by 0.2 m at least,
/// forwards. Nothing is converted.
class UnitCheck {
public:
    /// Messages in the order of their times; others do no harm.
    void add(const Message&);

    /// A sentence for each doubt, empty where there is none: by 80 % of at least ten yaws, speeds or lengths.
    std::vector<std::string> doubts() const;

    static constexpr size_t kReadings = 6;  ///< of yaw; the first is OSI's

private:
    struct Track {
        int64_t nanoseconds = 0;
        glm::dvec3 centre{0};
    };

    std::unordered_map<uint64_t, Track> tracks_;  // of the objects of the last message
    std::array<uint64_t, kReadings> yaws_{};
    uint64_t speeds_ = 0, high_speeds_ = 0, lengths_ = 0, long_lengths_ = 0;
};

}  // namespace vesper::osi
