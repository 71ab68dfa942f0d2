// Input of a driver, and the lamps that result. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace vesper::traffic {

enum class Beam : uint8_t { Off, Low, High };
enum class Indicator : uint8_t { None, Left, Right, Both };

/// Input of a driver during one step.
struct DriverInput {
    double steering = 0;  ///< of the wheel, -1 (right) .. 1 (left)
    double throttle = 0;  ///< 0 .. 1
    double brake = 0;     ///< 0 .. 1
    bool reverse = false;
    Beam beam = Beam::Low;
    Indicator indicator = Indicator::None;
    bool autopilot = false;  ///< steering, throttle and brake are the autopilot's
    bool operator==(const DriverInput&) const = default;
};

/// Lit lamps of a vehicle. Flashing indicators are lit for half of each period.
struct VehicleLamps {
    bool low = false, high = false, tail = false, brake = false, left = false, right = false, front_fog = false,
         rear_fog = false, reversing = false;
    Indicator indicator = Indicator::None;  ///< which of left and right flash
    bool operator==(const VehicleLamps&) const = default;
};

constexpr double kFlashPeriod = 2.0 / 3;  ///< s, of indicators: 90 a minute (UN Regulation 48, 6.5.9.1: 90 +/- 30)

/// The lamps of a vehicle at a time, s. `braking`: the pedal is pressed.
constexpr VehicleLamps lamps_of(Beam beam, Indicator indicator, bool braking, double seconds) {
    const double periods = seconds / kFlashPeriod;
    const bool lit = periods - double(int64_t(periods)) < 0.5;
    return {.low = beam != Beam::Off,
            .high = beam == Beam::High,
            .tail = beam != Beam::Off,
            .brake = braking,
            .left = lit && (indicator == Indicator::Left || indicator == Indicator::Both),
            .right = lit && (indicator == Indicator::Right || indicator == Indicator::Both),
            .indicator = indicator};
}

}  // namespace vesper::traffic
