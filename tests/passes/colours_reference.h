// Mean colours of squares of the picture. SPDX-License-Identifier: MIT
#pragma once

#include "passes/pyramid_reference.h"

namespace vesper::reference {

/// Mean colours and numbers of the finite pixels of squares of 32 px.
template <class Rgb>
PyramidLevel colour_tiles(std::span<const Rgb> scene, uint32_t width, uint32_t height) {
    PyramidLevel tiles{(width + 31) / 32, (height + 31) / 32, {}};
    tiles.texels.assign(size_t(tiles.width) * tiles.height, dvec4(0));
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const auto& p = scene[size_t(y) * width + x];
            const dvec3 rgb(p.x, p.y, p.z);
            if (finite(rgb)) tiles.texels[size_t(y / 32) * tiles.width + x / 32] += dvec4(rgb, 1);
        }
    for (dvec4& t : tiles.texels) t = dvec4(dvec3(t) / std::max(t.w, 1.0), t.w);
    return tiles;
}

}  // namespace vesper::reference
