// Photometric shading, one pixel and one lamp after another. SPDX-License-Identifier: MIT
// L = sum_k E_k (rho lambert + f_specular) + ambient rho lambert + emission, E_k = I_k cos / d^2 (Petit, Bremond and
// Vienne; Lambert 1760).
#pragma once

#include <numbers>

#include "passes/cluster_reference.h"
#include "passes/shade_measured_reference.h"
#include "passes/shade_retro_reference.h"
#include "shared/retro.h"
#include "shared/shade.h"

namespace vesper::reference {

/// One pixel of the G-buffer.
struct SurfaceTexel {
    dvec4 reflectance{0};  ///< base colour, metallic
    dvec4 surface{0};      ///< octahedral normal (2), depth in m (0: nothing), roughness
    dvec3 emission{0};     ///< cd/m^2
};

/// Unit vector of an octahedral map (Meyer et al. 2010; Cigolle et al. 2014), marked or not.
inline dvec3 octahedral_decode(dvec2 e) {
    if (e.x > 2) e.x -= 4;  // the mark of a relief
    const auto sign = [](double x) { return x < 0 ? -1.0 : 1.0; };
    dvec3 n(e, 1 - std::abs(e.x) - std::abs(e.y));
    if (n.z < 0) n = dvec3((1 - std::abs(e.y)) * sign(e.x), (1 - std::abs(e.x)) * sign(e.y), n.z);
    return glm::normalize(n);
}

/// Its inverse.
inline dvec2 octahedral_encode(dvec3 n) {
    const auto sign = [](double x) { return x < 0 ? -1.0 : 1.0; };
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    if (n.z >= 0) return dvec2(n);
    return {(1 - std::abs(n.y)) * sign(n.x), (1 - std::abs(n.x)) * sign(n.y)};
}

/// Normal-incidence reflectance: the base colour of a metal, 0.04 (1 - a^2) of a dielectric, a = roughness^2.
inline dvec3 normal_reflectance(dvec3 base, double metallic, double roughness) {
    const double a = roughness * roughness;
    return glm::mix(dvec3(0.04 * (1 - a * a)), base, metallic);
}

/// Specular reflection, sr^-1, and the part of it that rounding dot products by `epsilon` may change.
struct Specular {
    dvec3 value{0};
    double relative_rounding = 0;
};

/// GGX (Walter et al. 2007, Eq. 33) with height-correlated Smith masking (Heitz 2014, Eq. 99) and Schlick's Fresnel
/// term (1994), whose grazing reflectance fades with F0 (Lagarde and de Rousiers 2014: clamp(F0 / 0.04)).
inline Specular specular(dvec3 n, dvec3 l, dvec3 v, dvec3 f0, double roughness, double epsilon = 3e-7) {
    const double a = std::max(roughness * roughness, 1e-3), a2 = a * a;
    const dvec3 h = glm::normalize(l + v);
    const double nl = glm::dot(n, l), nv = std::max(glm::dot(n, v), 1e-4);
    const double nh = std::max(glm::dot(n, h), 0.0), vh = glm::dot(v, h);
    const double q = nh * nh * (a2 - 1) + 1;
    const double distribution = a2 / (std::numbers::pi * q * q);
    const double masking = 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
    const double f90 = std::clamp(25 * std::max({f0.x, f0.y, f0.z}), 0.0, 1.0);
    const dvec3 fresnel = f0 + (f90 - f0) * std::pow(1 - vh, 5);
    // q = a2 nh^2 + |n x h|^2 as the shader has it, so d(1/q^2) = 2 dq / q with dq = 2 sqrt(q) d(n x h); l + v is the
    // shorter the more its direction is rounded; masking moves with n.l and n.v relative to their size.
    const double half_rounding = epsilon * (1 + 1 / std::max(glm::length(l + v), 1e-9));
    const double rounding = 4 * half_rounding / std::sqrt(q) + 2 * half_rounding * half_rounding / q +
                            epsilon / std::max(nl, a) + epsilon / std::max(nv, a);
    return {distribution * masking * fresnel, std::min(rounding, 1.0)};
}

/// Scene luminance, and what single precision may change of it.
struct Shaded {
    dvec3 luminance{0};  ///< cd/m^2 RGB
    dvec3 rounding{0};   ///< cd/m^2, first order
};

/// A retroreflective surface: its class, if it is one, and its colour.
struct Sheet {
    const photometry::Retroreflector* retroreflector = nullptr;
    dvec3 base{0};
};

/// Adds one lamp. It counts where it gives at least `threshold` lx on a surface facing it, or, where the surface
/// is matt, on the surface itself; a directional one always does. Light that arrives from below the surface does not
/// count.
inline void add_lamp(const shared::Lamp& lamp, LampKind kind, dvec3 point, dvec3 n, dvec3 rho_lambert, dvec3 f0,
                     double roughness, double threshold, Shaded& sum, const MeasuredLamp* measured = nullptr,
                     const RoadSurface* road = nullptr, const Sheet& sheet = {}) {
    const dvec3 v = glm::normalize(-point);
    const bool placed = kind != LampKind::Directional;
    const dvec3 path = placed ? dvec3(lamp.position) - point : -dvec3(lamp.axis);
    const double d = glm::length(path);
    if (!(d > 0)) return;
    const dvec3 l = path / d;
    // Positions are rounded relative to their distance from the eye, which weighs more the nearer the lamp is.
    const double epsilon = 3e-7 * (placed ? 1 + (glm::length(point) + glm::length(dvec3(lamp.position))) / d : 1);
    const double cosine = glm::dot(dvec3(lamp.axis), -l), d2 = placed ? d * d : 1.0;
    const double e = (measured ? measured->intensity(-l) : intensity(lamp, kind, cosine)) / d2;
    // The device takes angles from polynomials (glsl/tables.glsl): 6e-4 of the value, and 2^-24 of the largest beside
    // an edge.
    const double more = measured ? e * 1.0006 + lamp.intensity / d2 * std::exp2(-24)
                                 : intensity(lamp, kind, std::min(cosine + epsilon, 1.0)) / d2 * (1 + 3 * epsilon);
    const double less = measured ? e * 0.9994 - lamp.intensity / d2 * std::exp2(-24)
                                 : intensity(lamp, kind, cosine - epsilon) / d2 * (1 - 3 * epsilon);
    const double nl = glm::dot(n, l);
    const double arriving = roughness < 1 ? 1 : std::max(nl, 0.0), blur = roughness < 1 ? 0 : epsilon;
    const bool may_count = !placed || std::max(more, less) * (arriving + blur) >= threshold;
    const bool uncertain = placed && std::min(more, less) * (arriving - blur) < threshold;
    if (nl <= -epsilon || !may_count) return;

    if (road) {
        const dvec3 reflected = dvec3(lamp.colour) * rho_lambert / road->diffuse;
        const photometry::ReflectionTable& table = road->table;
        if (nl > 0 && (!placed || e * arriving >= threshold))
            sum.luminance += reflected * e * road_coefficient(table, n, l, v);
        const double largest = *std::max_element(table.r.begin(), table.r.end()) * 145;
        const double value = nl > epsilon ? road_coefficient(table, n, l, v) : largest;
        // Cosines are known to 2e-7, so that beta is to 0.04 degrees near 0; W4 falls by 39 % a degree there.
        if (nl > epsilon)
            sum.rounding += reflected * std::max(more, less) *
                            std::abs(road_coefficient(table, n, l, v, 2e-7) - road_coefficient(table, n, l, v, -2e-7));
        sum.rounding +=
            reflected * value *
            (uncertain ? std::max(more, less) : more - less + 0.001 * e + e * epsilon / std::max(nl * nl, epsilon));
        return;
    }
    const Specular s = specular(n, l, v, f0, roughness, epsilon);
    const dvec3 reflected = dvec3(lamp.colour) * (rho_lambert + s.value);
    if (nl > 0 && (!placed || e * arriving >= threshold)) sum.luminance += reflected * e * nl;
    const double brightest = std::max(more, less);
    if (sheet.retroreflector && nl > 0) {
        const Returned back = returned(*sheet.retroreflector, n, l, v, epsilon);
        const dvec3 colour = sheet.base * dvec3(lamp.colour);
        if (!placed || e * arriving >= threshold) sum.luminance += colour * e * back.value;
        sum.rounding +=
            colour * ((uncertain ? brightest : std::abs(more - less)) * back.value + brightest * back.rounding);
    }
    sum.rounding +=
        uncertain ? reflected * brightest * std::max(nl, 0.0) : reflected * std::abs(more - less) * std::max(nl, 0.0);
    sum.rounding += glm::abs(reflected) * brightest * epsilon +
                    dvec3(lamp.colour) * s.value * brightest * std::max(nl, 0.0) * s.relative_rounding;
}

/// One pixel, in the view frame with the eye at the origin. Lamps sorted as p.lamps counts them.
inline Shaded shade(const SurfaceTexel& texel, shared::uvec2 pixel, std::span<const shared::Lamp> lamps,
                    const shared::ShadePush& p, const Measurements& measurements = {}) {
    const double depth = texel.surface.z;
    if (!(depth > 0)) return {dvec3(p.sky), dvec3(0)};
    const dvec3 point = view_position(p.grid, dvec2(pixel) + 0.5, depth);
    const dvec3 n = octahedral_decode(dvec2(texel.surface));
    const dvec3 base(texel.reflectance);
    const double kind = texel.reflectance.w, metallic = kind >= shared::kRetroCode ? 0 : std::max(kind, 0.0),
                 roughness = texel.surface.w;
    const RoadSurface* road = kind < 0 ? &measurements.roads[size_t(-1 - kind)] : nullptr;
    const Sheet sheet{kind >= shared::kRetroCode ? &measurements.sheets[size_t(kind - shared::kRetroCode)] : nullptr,
                      base};
    const dvec3 rho_lambert = base * (1 - metallic) * double(p.lambert);
    const dvec3 f0 = normal_reflectance(base, metallic, roughness);

    Shaded sum;
    const size_t tables = size_t(p.lamps.cones) + p.lamps.powers, count = tables + p.lamps.tables + p.lamps.directional;
    for (size_t i = 0; i < count; ++i)
        add_lamp(lamps[i], kind_of(i, p.lamps), point, n, rho_lambert, f0, roughness, p.threshold, sum,
                 kind_of(i, p.lamps) == LampKind::Table ? &measurements.lamps[i - tables] : nullptr, road, sheet);
    // A metal reflects its base colour too.
    sum.luminance += dvec3(p.ambient) * base * double(p.lambert) *
                     (road ? road_in_diffuse(-roughness, glm::dot(n, glm::normalize(-point))) : 1);
    sum.luminance += glm::min(texel.emission, dvec3(double(p.emission_limit)));
    return sum;
}

}  // namespace vesper::reference
