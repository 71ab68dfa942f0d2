// Codes of pictures as linear values, and what materials reflect with them. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "scene/scene.h"

namespace vesper {

/// The linear value of each 8-bit code: sRGB, or Eq. 1 of Petit, Bremond and Vienne.
std::array<double, 256> linear_codes(const Transfer& transfer);

/// The box of texture coordinates that something lies in. Empty (low > high): all of the picture.
struct UvBox {
    glm::dvec2 low{HUGE_VAL}, high{-HUGE_VAL};

    void add(glm::dvec2 uv) { low = glm::min(low, uv), high = glm::max(high, uv); }
};

/// Mean over the texels of a box, each by how much of it lies inside: the colour through a transfer, opacity code / 255. An axis on which the
/// box spans 1 or more counts whole.
glm::dvec4 mean_texel(const Image& image, const Transfer& transfer, const TextureUse& use, const UvBox& box = {});

/// What of a material is shown.
struct MaterialUse {
    double area = 0;          ///< m^2 of all nodes; where a node stretches unevenly, by the mean square of its three scales
    glm::dvec3 colour{1};     ///< mean of the vertex colours over that area
    UvBox uv;
};

/// One for each material. Those that no node shows are taken for white and whole.
std::vector<MaterialUse> material_uses(const Scene& scene);

/// Mean reflectance (luminance) of the surfaces of a material: base colour, vertex colours, and what of its texture they use.
double mean_reflectance(const Scene& scene, const Material& material, const MaterialUse& use);

}  // namespace vesper
