// The sky as an equirectangular picture: luminances and illuminance. SPDX-License-Identifier: MIT
// World frame of glTF: +Y up. Azimuth 0 is -Z, where a camera looks by default, and grows to the right, so that +X is
// at 90 degrees. The picture's first row is the zenith, its centre lies at the azimuth `rotation`.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace vesper::io {
struct HdrImage;
}  // namespace vesper::io

namespace vesper::photometry {

/// Luminance from every direction, far away.
struct Environment {
    uint32_t width = 0, height = 0;
    std::vector<float> rgb;  ///< cd/m^2 RGB (Rec. 709), rows from the zenith, finite and at least 0
    double rotation = 0;     ///< azimuth of the picture's centre, rad
};

constexpr uint32_t kMaxEnvironmentWidth = 1024;  ///< px; larger pictures are averaged down

/// From a picture, its values taken for cd/m^2. Averaged to at most kMaxEnvironmentWidth columns, solid angle by solid
/// angle, so that illuminances are kept. Values that are not finite or below 0 become 0; the number of such pixels is
/// added to `cleaned`. Throws Error (reason only) unless the picture is twice as wide as high.
Environment make_environment(const io::HdrImage&, uint64_t* cleaned = nullptr);

/// Unit direction of azimuth and elevation, rad.
glm::dvec3 direction_of(double azimuth, double elevation);
/// World direction of a place in the picture, px from its upper left corner; the centre of the first pixel is (0.5,
/// 0.5).
glm::dvec3 direction_at(const Environment&, glm::dvec2 place);
/// Inverse of direction_at(). `direction` has any length.
glm::dvec2 place_of(const Environment&, glm::dvec3 direction);
/// Solid angle of every pixel of a row, sr.
double solid_angle_of_row(const Environment&, uint32_t y);

/// Luminance in a direction, bilinear between the centres of pixels, cd/m^2 RGB.
glm::dvec3 luminance_of(const Environment&, glm::dvec3 direction);

/// Illuminance on a surface of normal `n` by summing up all pixels, lx RGB.
glm::dvec3 irradiance(const Environment&, glm::dvec3 n);

/// Illuminance on surfaces of every normal as a quadratic polynomial (spherical harmonics up to order 2, R. Ramamoorthi
/// and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001), lx RGB: factors of
/// 1, y, z, x, xy, yz, 3 z^2 - 1, xz, x^2 - y^2. The error at normals that point up is corrected by the least change of
/// the others, so that level ground has the exact illuminance.
using Irradiance9 = std::array<glm::dvec3, 9>;
Irradiance9 irradiance_polynomial(const Environment&);
/// Value of the polynomial, at least 0 (it may ring below 0 opposite a bright spot).
glm::dvec3 evaluate(const Irradiance9&, glm::dvec3 n);

/// Mean luminance above the horizon, cd/m^2.
double sky_luminance(const Environment&);
/// Illuminance of a horizontal surface facing up, lx.
double horizontal_illuminance(const Environment&);
/// All luminances times a factor. Throws Error (reason only) when they do not stay finite.
Environment scaled(Environment, double factor);

}  // namespace vesper::photometry
