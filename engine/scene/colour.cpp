// Colour of a black body: Planck's law seen by the CIE 1931 observer. SPDX-License-Identifier: MIT
#include "scene/colour.h"

#include <cmath>

#include "base/error.h"
#include "io/primaries.h"
#include "photometry/observer.h"

namespace vesper::scene {
namespace {

glm::dvec3 xyz_of_black_body(double kelvin) {
    glm::dvec3 xyz(0);
    for (int i = 0; i < photometry::kWavelengths; ++i)
        xyz += photometry::black_body(photometry::wavelength(i), kelvin) * photometry::kObserver[size_t(i)];
    return xyz;
}

}  // namespace

glm::vec3 colour_of_temperature(double kelvin) {
    if (!(kelvin >= 1000 && kelvin <= 25000)) throw Error("colour temperature must be from 1000 to 25000 K");
    const glm::dvec3 rgb = glm::max(io::to_rec709(io::kXyz) * xyz_of_black_body(kelvin), glm::dvec3(0));
    return glm::vec3(rgb / luminance(rgb));
}

glm::dvec2 chromaticity(glm::dvec3 c) {
    const glm::dvec3 xyz = glm::inverse(io::to_rec709(io::kXyz)) * c;
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

}  // namespace vesper::scene
