// Colour of a black body: Planck's law seen by the CIE 1931 observer. SPDX-License-Identifier: MIT
#include "scene/colour.h"

#include <cmath>

#include "base/error.h"
#include "io/primaries.h"

namespace vesper {
namespace {

/// CIE 1931 2 degree colour matching functions, 380 to 780 nm in steps of 10 nm (CIE 15, rounded to four digits).
constexpr double kObserver[41][3] = {
    {0.0014, 0.0000, 0.0065}, {0.0042, 0.0001, 0.0201}, {0.0143, 0.0004, 0.0679}, {0.0435, 0.0012, 0.2074},
    {0.1344, 0.0040, 0.6456}, {0.2839, 0.0116, 1.3856}, {0.3483, 0.0230, 1.7471}, {0.3362, 0.0380, 1.7721},
    {0.2908, 0.0600, 1.6692}, {0.1954, 0.0910, 1.2876}, {0.0956, 0.1390, 0.8130}, {0.0320, 0.2080, 0.4652},
    {0.0049, 0.3230, 0.2720}, {0.0093, 0.5030, 0.1582}, {0.0633, 0.7100, 0.0782}, {0.1655, 0.8620, 0.0422},
    {0.2904, 0.9540, 0.0203}, {0.4334, 0.9950, 0.0087}, {0.5945, 0.9950, 0.0039}, {0.7621, 0.9520, 0.0021},
    {0.9163, 0.8700, 0.0017}, {1.0263, 0.7570, 0.0011}, {1.0622, 0.6310, 0.0008}, {1.0026, 0.5030, 0.0003},
    {0.8544, 0.3810, 0.0002}, {0.6424, 0.2650, 0.0000}, {0.4479, 0.1750, 0.0000}, {0.2835, 0.1070, 0.0000},
    {0.1649, 0.0610, 0.0000}, {0.0874, 0.0320, 0.0000}, {0.0468, 0.0170, 0.0000}, {0.0227, 0.0082, 0.0000},
    {0.0114, 0.0041, 0.0000}, {0.0058, 0.0021, 0.0000}, {0.0029, 0.0010, 0.0000}, {0.0014, 0.0005, 0.0000},
    {0.0007, 0.0003, 0.0000}, {0.0003, 0.0001, 0.0000}, {0.0002, 0.0001, 0.0000}, {0.0001, 0.0000, 0.0000},
    {0.0000, 0.0000, 0.0000},
};
constexpr double kSecondRadiation = 1.4388e-2;  // c2 of ITS-90, m K

glm::dvec3 xyz_of_black_body(double kelvin) {
    glm::dvec3 xyz(0);
    for (int i = 0; i < 41; ++i) {
        const double metres = (380 + 10 * i) * 1e-9;
        // Relative to 560 nm, which keeps the numbers moderate.
        const double radiance = std::pow(560e-9 / metres, 5) * std::expm1(kSecondRadiation / (560e-9 * kelvin)) /
                                std::expm1(kSecondRadiation / (metres * kelvin));
        xyz += radiance * glm::dvec3(kObserver[i][0], kObserver[i][1], kObserver[i][2]);
    }
    return xyz;
}

}  // namespace

glm::vec3 colour_of_temperature(double kelvin) {
    if (!(kelvin >= 1000 && kelvin <= 25000)) throw Error("colour temperature must be from 1000 to 25000 K");
    const glm::dvec3 rgb = glm::max(to_rec709(kXyz) * xyz_of_black_body(kelvin), glm::dvec3(0));
    return glm::vec3(rgb / luminance(rgb));
}

glm::dvec2 chromaticity(glm::dvec3 c) {
    const glm::dvec3 xyz = glm::inverse(to_rec709(kXyz)) * c;
    const double sum = xyz.x + xyz.y + xyz.z;
    return sum == 0 ? glm::dvec2(0) : glm::dvec2(xyz) / sum;
}

double temperature_of(glm::dvec3 rgb) {
    const glm::dvec2 xy = chromaticity(rgb);
    const double n = (xy.x - 0.3320) / (0.1858 - xy.y);
    const double kelvin = ((449 * n + 3525) * n + 6823.3) * n + 5520.33;
    if (!(kelvin >= 1000 && kelvin <= 25000)) return 0;
    return glm::distance(xy, chromaticity(glm::dvec3(colour_of_temperature(kelvin)))) < 0.02 ? kelvin : 0;
}

}  // namespace vesper
