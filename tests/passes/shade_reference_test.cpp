// Shading in double, against closed forms and the properties of its parts. SPDX-License-Identifier: MIT
#include "passes/shade_reference.h"

#include <random>

#include <gtest/gtest.h>

namespace vesper::reference::shade_reference_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A view of one pixel that looks straight ahead.
shared::ShadePush ahead(uint32_t cones, uint32_t powers = 0, uint32_t directional = 0) {
    shared::ShadePush p{};
    p.size = {1, 1};
    p.grid.ray_scale = {1, -1};
    p.grid.ray_offset = {-0.5f, 0.5f};
    p.lamps = {cones, powers, 0, directional};
    p.threshold = 0.001f;
    p.lambert = float(1 / kPi);
    p.emission_limit = std::numeric_limits<float>::infinity();
    return p;
}

SurfaceTexel wall(double depth, dvec3 normal = {0, 0, 1}, double roughness = 1,
                  dvec4 reflectance = dvec4(0.5, 0.5, 0.5, 0)) {
    return {reflectance, dvec4(octahedral_encode(glm::normalize(normal)), depth, roughness), dvec3(0)};
}

shared::Lamp point_lamp(glm::vec3 position, float candela, glm::vec3 colour = glm::vec3(1)) {
    return {position, candela, {0, 0, -1}, 0.0f, colour, 1.0f, {1, 0, 0}, -1.0f};
}

Shaded shade_one(const SurfaceTexel& texel, const std::vector<shared::Lamp>& lamps, const shared::ShadePush& p) {
    return shade(texel, {0, 0}, lamps, p);
}

TEST(ShadeReference, OneLampOnALambertSurface) {
    // 2000 cd, 3 m in front of the wall and 4 m aside: d = 5 m, cos = 3/5.
    const auto got = shade_one(wall(10), {point_lamp({4, 0, -7}, 2000)}, ahead(1));
    EXPECT_NEAR(got.luminance.y, 0.5 * 2000 * 0.6 / (kPi * 25), 1e-6);
    EXPECT_LT(got.rounding.y, 1e-4 * got.luminance.y);
}

TEST(ShadeReference, ThePapersLambertIsPiTimesBrighter) {
    shared::ShadePush p = ahead(1);
    const std::vector lamps{point_lamp({1, 2, -3}, 700)};
    const double physical = shade_one(wall(8), lamps, p).luminance.y;
    p.lambert = 1;
    EXPECT_NEAR(shade_one(wall(8), lamps, p).luminance.y / physical, kPi, 1e-6);
}

TEST(ShadeReference, LampsAddAndScale) {
    const auto a = point_lamp({1, 2, -3}, 700, {1.2f, 0.9f, 1.1f}), b = point_lamp({-3, 1, -1}, 300);
    const SurfaceTexel texel = wall(8, {0.2, 0.1, 1}, 0.4);
    const dvec3 sum = shade_one(texel, {a, b}, ahead(2)).luminance;
    const dvec3 each = shade_one(texel, {a}, ahead(1)).luminance + shade_one(texel, {b}, ahead(1)).luminance;
    EXPECT_NEAR(glm::length(sum - each), 0, 1e-12);
    EXPECT_GT(sum.y, 0);
}

TEST(ShadeReference, ALampBelowTheThresholdIsDark) {
    // 0.1 cd from 10 m: 0.001 lx on a facing surface, whatever the angle of a glossy one.
    for (float candela : {0.0999f, 0.1001f}) {
        SurfaceTexel glossy = wall(10, {0, 1, 0.01});
        glossy.surface.w = 0.9;
        EXPECT_EQ(shade_one(glossy, {point_lamp({0, 0, 0}, candela)}, ahead(1)).luminance.y > 0, candela > 0.1f);
    }
    // A matt one at 60 degrees needs twice as much.
    for (float candela : {0.1999f, 0.2001f}) {
        const auto got = shade_one(wall(10, {0, std::sqrt(3), 1}), {point_lamp({0, 0, 0}, candela)}, ahead(1));
        EXPECT_EQ(got.luminance.y > 0, candela > 0.2f);
    }
    const auto at_the_edge = shade_one(wall(10), {point_lamp({0, 0, 0}, 0.1f)}, ahead(1));
    EXPECT_GE(at_the_edge.rounding.y, 0.5 * 0.001 / kPi) << "rounding decides here: all of it is in doubt";
}

TEST(ShadeReference, ADirectionalLightHasNoDistanceAndNoThreshold) {
    shared::Lamp moon = point_lamp({0, 0, 0}, 0.0002f);
    moon.axis = glm::normalize(glm::vec3(0, -3, -4));
    const double want = 0.5 * 0.0002 * 0.8 / kPi;
    EXPECT_NEAR(shade_one(wall(1), {moon}, ahead(0, 0, 1)).luminance.y, want, 1e-9);
    EXPECT_NEAR(shade_one(wall(1000), {moon}, ahead(0, 0, 1)).luminance.y, want, 1e-9);
}

TEST(ShadeReference, LightFromBehindTheSurfaceDoesNotCount) {
    EXPECT_EQ(shade_one(wall(5), {point_lamp({0, 0, -6}, 1e6f)}, ahead(1)).luminance, dvec3(0));
    shared::Lamp lobe = point_lamp({0, 0, 0}, 1000);
    lobe.lobe_a = 2, lobe.axis = {0, 0, 1};  // shines away from the wall
    EXPECT_EQ(shade_one(wall(5), {lobe}, ahead(0, 1)).luminance, dvec3(0));
}

TEST(ShadeReference, AmbientSkyAndEmission) {
    shared::ShadePush p = ahead(0);
    p.ambient = {3, 2, 1}, p.sky = {0.1f, 0.2f, 0.3f};
    const dvec3 diffuse = shade_one(wall(5, {0, 1, 1}), {}, p).luminance;
    EXPECT_NEAR(diffuse.x, 3 * 0.5 / kPi, 1e-6);
    const dvec3 metal = shade_one(wall(5, {0, 1, 1}, 0.3, {0.5, 0.5, 0.5, 1}), {}, p).luminance;
    EXPECT_NEAR(metal.x, diffuse.x, 1e-9) << "a metal reflects its base colour of the ambient light";
    EXPECT_EQ(shade_one(wall(0), {}, p).luminance, dvec3(p.sky));

    SurfaceTexel sign = wall(5);
    sign.emission = {1e8, 5, 0};
    EXPECT_NEAR(shade_one(sign, {}, ahead(0)).luminance.x, 1e8, 1e-3);
    p = ahead(0), p.emission_limit = 1;
    EXPECT_EQ(shade_one(sign, {}, p).luminance, dvec3(1, 1, 0));
}

TEST(ShadeReference, OctahedralMapIsInvertible) {
    for (dvec3 axis : {dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, 1), dvec3(0, 0, -1)})
        EXPECT_NEAR(glm::length(octahedral_decode(octahedral_encode(axis)) - axis), 0, 1e-15);
    EXPECT_EQ(octahedral_decode(dvec2(0)), dvec3(0, 0, 1));
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 1000; ++i) {
        const dvec3 n = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
        EXPECT_NEAR(glm::length(octahedral_decode(octahedral_encode(n)) - n), 0, 1e-14);
    }
}

dvec3 toward(double angle, double azimuth = 0) {
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)};
}

TEST(ShadeReference, RoughnessOneIsLambert) {
    const dvec3 f0 = normal_reflectance(dvec3(0.7), 0, 1);
    EXPECT_EQ(specular({0, 0, 1}, toward(0.3), toward(-1.2), f0, 1).value, dvec3(0));
}

TEST(ShadeReference, SpecularInClosedForm) {
    // Everything along the normal: D = 1 / (pi a^2), V = 1/4.
    for (double roughness : {0.1, 0.5, 0.9}) {
        const double a = roughness * roughness;
        const dvec3 n(0, 0, 1);
        EXPECT_NEAR(specular(n, n, n, dvec3(0.8), roughness).value.x, 0.8 / (4 * kPi * a * a), 1e-9 / (a * a));
    }
    EXPECT_NEAR(specular({0, 0, 1}, {0, 0, 1}, {0, 0, 1}, dvec3(1), 0).value.x, 1 / (4 * kPi * 1e-6), 1) << "a >= 1e-3";
}

TEST(ShadeReference, DielectricsReflectFourPerCentAndMetalsTheirColour) {
    EXPECT_NEAR(normal_reflectance(dvec3(0.7), 0, 0).x, 0.04, 1e-12);
    EXPECT_NEAR(normal_reflectance(dvec3(0.7), 0, std::sqrt(0.5)).x, 0.04 * 0.75, 1e-12);
    EXPECT_EQ(normal_reflectance({0.9, 0.6, 0.3}, 1, 0.5), dvec3(0.9, 0.6, 0.3));
}

TEST(ShadeReference, SpecularIsReciprocal) {
    for (double a : {0.1, 0.7, 1.3})
        for (double b : {0.2, 0.9, 1.4}) {
            const double there = specular({0, 0, 1}, toward(a), toward(b, 2), dvec3(0.04), 0.4).value.x;
            EXPECT_NEAR(there, specular({0, 0, 1}, toward(b, 2), toward(a), dvec3(0.04), 0.4).value.x, 1e-12 * there);
        }
}

/// Reflected part of light from `angle` off a white metal: integral of f cos over the hemisphere.
double albedo(double angle, double roughness) {
    const int rows = 800, columns = 400;
    double sum = 0;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double sine2 = (i + 0.5) / rows,
                         azimuth = 2 * kPi * (j + 0.5) / columns;  // uniform in sin^2: cos-weighted
            sum += specular({0, 0, 1}, toward(std::asin(std::sqrt(sine2)), azimuth), toward(angle), dvec3(1), roughness)
                       .value.x;
        }
    return kPi * sum / (rows * columns);
}

// Walter et al. 2007: D cos is normalised over the hemisphere, so a smooth white metal reflects nearly everything;
// single scattering loses light as it gets rough, and never gains any.
TEST(ShadeReference, WhiteMetalConservesEnergy) {
    EXPECT_NEAR(albedo(0.2, 0.35), 0.98, 0.01);
    for (double angle : {0.1, 0.8, 1.3})
        for (double roughness : {0.4, 0.7}) {
            EXPECT_LE(albedo(angle, roughness), 1.001) << angle << ' ' << roughness;
            EXPECT_GE(albedo(angle, roughness), 0.6) << angle << ' ' << roughness;
        }
}

// At a = 1, D = 1 / pi and V = 1 / (2 (n.l + n.v)), whose integral is 1 - n.v ln((1 + n.v) / n.v): 1 - ln 2 head on.
TEST(ShadeReference, RoughWhiteMetalHasItsAlbedoInClosedForm) {
    EXPECT_NEAR(albedo(0, 1), 1 - std::numbers::ln2, 1e-3);
    for (double angle : {0.5, 1.0, 1.4}) {
        const double nv = std::cos(angle);
        EXPECT_NEAR(albedo(angle, 1), 1 - nv * std::log((1 + nv) / nv), 1e-3) << angle;
    }
}

TEST(ShadeReference, GrazingLightIsReflectedWhole) {
    // Schlick: F = 1 where v.h = 0; the difference between F0 = 0.04 and F0 = 1 vanishes there.
    const dvec3 l = toward(1.5607), v = toward(-1.5607);
    EXPECT_NEAR(specular({0, 0, 1}, l, v, dvec3(0.04), 0.3).value.x / specular({0, 0, 1}, l, v, dvec3(1), 0.3).value.x,
                1, 0.06);
    const Specular half = specular({0, 0, 1}, l, v, dvec3(0.02), 0.3);
    EXPECT_NEAR(half.value.x / specular({0, 0, 1}, l, v, dvec3(0.04), 0.3).value.x, 0.5, 0.01) << "F90 fades with F0";
}

// Moving a lamp from 1 m to 1 km changes the luminance by 1e6 and nothing else: no window, no clamp.
TEST(ShadeReference, TheInverseSquareLawHasNoWindow) {
    const double near = shade_one(wall(1), {point_lamp({0, 0, 0}, 1e5f)}, ahead(1)).luminance.y;
    EXPECT_NEAR(near / shade_one(wall(1000), {point_lamp({0, 0, 0}, 1e5f)}, ahead(1)).luminance.y, 1e6, 1);
}

}  // namespace
}  // namespace vesper::reference::shade_reference_test
