// A sky that is a picture, one pixel after another, in double. SPDX-License-Identifier: MIT
// L = sky(ray) where nothing is drawn; elsewhere L + E(n) rho lambert + sky blurred to the lobe about the reflected ray
// times the fraction F0 A + F90 B that the lobe reflects (B. Karis, "Real Shading in Unreal Engine 4", 2013).
#pragma once

#include "gpu_scene/view.h"
#include "passes/shade_reference.h"
#include "photometry/sky_map.h"

namespace vesper::reference {

/// The sky in a lobe of a roughness: between two maps, or the sharp one and the first.
inline dvec3 blurred_sky(const photometry::SkyMap& sky, dvec3 direction, double roughness) {
    const double level = std::clamp(roughness, 0.0, 1.0) * photometry::kSkyLobes;
    const auto below = std::min(size_t(level), size_t(photometry::kSkyLobes - 1));
    const photometry::OctahedralMap& low = below == 0 ? sky.sharp : sky.lobes[below - 1];
    return glm::mix(photometry::luminance_of(low, direction), photometry::luminance_of(sky.lobes[below], direction),
                    level - double(below));
}

/// One pixel in the view frame; `luminance` is what the lamps and emission gave it. Fractions are integrated here, not
/// looked up.
inline dvec3 add_sky(const photometry::SkyMap& sky, const SurfaceTexel& texel, dvec3 luminance, glm::dvec2 pixel_centre,
                     const gpu_scene::View& view, double lambert) {
    const glm::dmat3 world = glm::transpose(glm::dmat3(view.world_to_view));
    const glm::dvec2 slope = glm::dvec2(view.ray_scale()) * pixel_centre + glm::dvec2(view.ray_offset());
    const dvec3 ray = world * glm::normalize(dvec3(slope, -1));
    if (!(texel.surface.z > 0)) return photometry::luminance_of(sky.sharp, ray);
    const double code = texel.reflectance.w, metallic = code >= 0 && code <= 1 ? code : 0, roughness = texel.surface.w;
    const dvec3 n = world * octahedral_decode(dvec2(texel.surface)), base(texel.reflectance);
    const bool road = code <= shared::kRoadKind;
    luminance += photometry::evaluate(sky.irradiance, n) * base *
                 ((road ? road_in_diffuse(-roughness, -glm::dot(n, ray)) : 1 - metallic) * lambert);
    if (road || (roughness >= 1 && metallic == 0)) return luminance;
    const dvec3 f0 = normal_reflectance(base, metallic, roughness);
    const double f90 = std::clamp(25 * std::max({f0.x, f0.y, f0.z}), 0.0, 1.0);
    const photometry::Reflected fraction =
        photometry::specular_reflectance(std::clamp(-glm::dot(n, ray), 0.0, 1.0), roughness, 1024);
    return luminance +
           blurred_sky(sky, glm::reflect(ray, n), roughness) * (f0 * fraction.scale + f90 * fraction.offset);
}

}  // namespace vesper::reference
