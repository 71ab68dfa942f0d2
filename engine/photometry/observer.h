// The CIE 1931 observer and light of a temperature, wavelength by wavelength. SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include <glm/glm.hpp>

namespace vesper::photometry {

constexpr int kWavelengths = 41;
/// Of a step of the tables here, nm.
constexpr double wavelength(int i) { return 380 + 10 * i; }

/// CIE 1931 2 degree colour matching functions X, Y, Z (CIE 15, rounded to four digits).
extern const std::array<glm::dvec3, kWavelengths> kObserver;

/// Radiance of a black body (Planck) over that at 560 nm.
double black_body(double nanometres, double kelvin);

/// Share of each wavelength in R, G and B of white light (a black body of 6500 K). Shares of a channel add to 1 and may
/// be negative.
std::array<glm::dvec3, kWavelengths> white_light();

}  // namespace vesper::photometry
