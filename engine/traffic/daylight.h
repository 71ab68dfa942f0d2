// Light of the sky between day and night. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace vesper::traffic {

/// Illuminance on level ground under a clear sky, lx, of sun and twilight, for an elevation of the sun in degrees, -90
/// .. 90 (Janiczek and DeYoung, US Naval Observatory Circular 171, 1987). Below -18 degrees it is constant, 6.5e-4 lx.
double daylight_illuminance(double sun_elevation);

/// Transmission of an overcast sky, evenly from all directions (same source: average clouds, 1/3).
constexpr double kOvercast = 1.0 / 3;

/// Correlated colour temperature of an overcast sky, K: 6500 by day; after sunset the light is bluer, up to 12000 K at
/// the end of civil twilight (Lee and Hernandez-Andres 2003).
double daylight_temperature(double sun_elevation);

}  // namespace vesper::traffic
