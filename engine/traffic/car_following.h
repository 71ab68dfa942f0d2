// How cars follow one another. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace vesper::traffic {

/// The Intelligent Driver Model (Treiber, Hennecke and Helbing 2000, Eqs. 3 and 4); defaults: city traffic of Treiber
/// and Kesting, Traffic Flow Dynamics (2013), table 11.2.
struct CarFollowing {
    double speed = 54 / 3.6;    ///< desired on a free road, m/s
    double headway = 1.0;       ///< T, s
    double distance = 2;        ///< s0, between standing cars, m
    double acceleration = 1;    ///< a, m/s^2
    double deceleration = 1.5;  ///< b, comfortable, m/s^2
    double exponent = 4;        ///< delta
    double hardest = 8;         ///< limit of braking, m/s^2: dry road
};

/// Acceleration, m/s^2. `gap`: from bumper to bumper, m (infinite: no leader). `closing`: its rate of decrease, m/s.
inline double idm_acceleration(const CarFollowing& p, double speed, double gap, double closing) {
    const double wanted =
        p.distance +
        std::max(0.0, speed * p.headway + speed * closing / (2 * std::sqrt(p.acceleration * p.deceleration)));
    const double near = std::isinf(gap) ? 0 : wanted / std::max(gap, 0.1);
    const double a = p.acceleration * (1 - std::pow(std::max(speed, 0.0) / p.speed, p.exponent) - near * near);
    return std::max(a, -p.hardest);
}

}  // namespace vesper::traffic
