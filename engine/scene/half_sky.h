// Pictures of the sky as files of scenes hold them. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photometry/environment.h"

namespace vesper::scene {

/// Half floats, little endian; times `scale` they are cd/m^2.
struct HalfSky {
    std::vector<uint8_t> bytes;
    double scale = 1;
};

/// The scale brings the brightest to 60,000: nine decades in full precision below it.
HalfSky half_floats_of(const photometry::Environment&);

/// The luminance of two such bytes.
float half_luminance(const uint8_t* bytes, double scale);

/// The picture rounded as it is where it goes through half floats; through them again it stays as it is.
photometry::Environment as_half_floats(photometry::Environment);

}  // namespace vesper::scene
