// What a projector shows, one pixel after another. SPDX-License-Identifier: MIT
#pragma once

#include "passes/composite_reference.h"
#include "shared/projection.h"

namespace vesper::reference {

/// Light of a projector's pixel, relative as that of the picture.
template <class Rgb>
dvec3 projected_light(std::span<const Rgb> light, uint32_t width, uint32_t height,
                      const shared::ProjectedPixel& pixel) {
    if (pixel.factor < 0) return dvec3(0);
    return double(pixel.factor) * bilinear(light, width, height, dvec2(pixel.at) - 0.5);
}

/// Its codes, not yet rounded.
template <class Rgb>
dvec3 projected(std::span<const Rgb> light, uint32_t width, uint32_t height, const shared::ProjectedPixel& pixel,
                const vision::Display& display) {
    return code(projected_light(light, width, height, pixel), display);
}

}  // namespace vesper::reference
