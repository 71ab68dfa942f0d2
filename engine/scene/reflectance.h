// Linear values of picture codes, and mean reflectance of materials. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "base/image.h"
#include "scene/material.h"

namespace vesper::scene {

struct Scene;

/// The linear value of each 8-bit code: sRGB, or Eq. 1 of Petit, Bremond and Vienne.
std::array<double, 256> linear_codes(const Transfer& transfer);

/// A box of texture coordinates. Empty (low > high): the whole picture.
struct UvBox {
    glm::dvec2 low{HUGE_VAL}, high{-HUGE_VAL};

    void add(glm::dvec2 uv) { low = glm::min(low, uv), high = glm::max(high, uv); }
};

/// Mean over the texels of a box, weighted by their area inside: colour through a transfer, opacity as code / 255. An
/// axis on which the box spans 1 or more counts whole.
glm::dvec4 mean_texel(const Image& image, const Transfer& transfer, const TextureUse& use, const UvBox& box = {});

/// Shown area, colour and texture coordinates of a material.
struct MaterialUse {
    double area = 0;       ///< m^2 of all nodes; uneven scales count by their mean square
    glm::dvec3 colour{1};  ///< mean of the vertex colours over that area
    UvBox uv;
};

/// Uses of all materials. A material that no node shows counts as white, with its whole texture.
std::vector<MaterialUse> material_uses(const Scene& scene);

/// Mean reflectance (luminance) of the surfaces of a material: base colour, vertex colours, and the used part of its
/// texture.
double mean_reflectance(const Scene& scene, const Material& material, const MaterialUse& use);

}  // namespace vesper::scene
