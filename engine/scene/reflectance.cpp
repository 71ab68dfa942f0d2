// Decoding of reflectance. SPDX-License-Identifier: MIT
#include "scene/reflectance.h"

#include <algorithm>
#include <cmath>

#include "base/srgb.h"
#include "scene/colour.h"

namespace vesper {

std::array<double, 256> linear_codes(const Transfer& transfer) {
    std::array<double, 256> linear{};
    for (size_t code = 0; code < 256; ++code) {
        const double c = static_cast<double>(code) / 255;
        linear[code] = transfer.kind == Transfer::Kind::Gamma ? std::pow(c, static_cast<double>(transfer.gamma)) : srgb_to_linear(c);
    }
    return linear;
}

double mean_reflectance(const Scene& scene, const Material& material, const Transfer& transfer) {
    const glm::dvec3 factor(material.base_colour);
    if (material.base_colour_texture.image == kNone) return luminance(factor);
    const std::array<double, 256> linear = linear_codes(transfer);
    const Image& image = scene.images[material.base_colour_texture.image];
    // A histogram per channel first: sums over codes are exact and quick.
    std::array<std::array<uint64_t, 256>, 3> counts{};
    for (size_t i = 0; i + 3 < image.rgba.size(); i += 4)
        for (size_t c = 0; c < 3; ++c) ++counts[c][image.rgba[i + c]];
    glm::dvec3 mean(0);
    for (size_t c = 0; c < 3; ++c)
        for (size_t code = 0; code < 256; ++code)
            mean[static_cast<int>(c)] += linear[code] * static_cast<double>(counts[c][code]);
    mean /= static_cast<double>(std::max<size_t>(1, image.rgba.size() / 4));
    return luminance(factor * mean);
}

}  // namespace vesper
