// Light of all lamps on surfaces. SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <numbers>

#include <glm/glm.hpp>

#include "render/light_settings.h"
#include "render/shadows/visibility.h"
#include "shared/shade.h"

namespace vesper::render {

struct ShadeSettings {
    float lambert = 1 / std::numbers::pi_v<float>;  ///< sr^-1: L = E reflectance / pi; 1: the paper's L = E R
    float emission_limit = std::numeric_limits<float>::infinity();  ///< cd/m^2
    glm::vec3 ambient{0};                                           ///< illuminance, RGB of luminance lx
    glm::vec3 sky{0};                                               ///< cd/m^2 RGB
    bool all_lamps = false;                             ///< evaluate every lamp in every pixel, for comparison
    float merge_error = LightSettings{}.merge_error;    ///< of add_merging
    FrameShadowMaps maps{};                             ///< of the lamps; without: nothing hides a lamp
    float shadow_error = LightSettings{}.shadow_error;  ///< of add_visibility
    float probe_error = LightSettings{}.probe_error;    ///< likewise
    graph::Resource retro{};  ///< rgba32f texels of shared/retro.h; without: no surface is retroreflective
};

/// Turns the emission of a G-buffer, in place, into scene luminance, rgba32f, cd/m^2 RGB (alpha 1):
/// L = sum_k E_k (rho lambert + specular) + ambient rho lambert + emission, E_k = I_k(direction) cos / d^2, counted
/// where E_k (on surfaces of roughness 1) or I_k / d^2 (on others) >= threshold. rho = base colour (1 - metallic). A
/// road with a table reflects after CIE 144 (shared/shade.h) and has no specular lobe. Specular: GGX (Walter et al.
/// 2007, a = roughness^2) with height-correlated Smith masking (Heitz 2014) and Schlick's Fresnel; F0 is the base
/// colour of a metal and 0.04 (1 - a^2) of a dielectric, so that roughness 1 is Lambert. Retroreflective surfaces
/// (photometry/retroreflection.h) add R_A I / d^2 / cos(view) times their base colour for every lamp in front of them.
/// With shadow maps E_k is times the share of the lamp that the point sees.
graph::Resource add_shading(const FrameContext& frame, const GBuffer& surfaces, const Clusters& clusters,
                            const Blocks& blocks, const ShadeSettings& settings);

}  // namespace vesper::render
