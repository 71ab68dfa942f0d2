// The reference of the sky pass against closed forms. SPDX-License-Identifier: MIT
#include "passes/sky_reference.h"

#include <gtest/gtest.h>

namespace vesper::test::sky_reference_test {
namespace {

using glm::dvec3;

photometry::SkyMap uniform(float luminance) {
    return photometry::make_sky_map({64, 32, std::vector<float>(64 * 32 * 3, luminance)});
}

reference::SurfaceTexel facing_eye(dvec3 base, double metallic, double roughness) {
    return {glm::dvec4(base, metallic), glm::dvec4(0, 0, 10, roughness), dvec3(0)};
}

const gpu_scene::View kView = gpu_scene::View::symmetric({9, 9}, 0.5f, glm::mat4(1));
constexpr glm::dvec2 kCentre{4.5, 4.5};

// Under a uniform sky of luminance L a Lambert surface of reflectance rho has rho L, whichever way it faces.
TEST(SkyReference, LambertUnderAUniformSky) {
    const photometry::SkyMap sky = uniform(3);
    const dvec3 got =
        reference::add_sky(sky, facing_eye({0.5, 0.25, 1}, 0, 1), dvec3(7), kCentre, kView, 1 / 3.14159265358979);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], 7 + 3 * dvec3(0.5, 0.25, 1)[c], 1e-2);
}

TEST(SkyReference, AMirrorShowsTheSkyBehindTheEye) {
    photometry::SkyMap sky = photometry::make_sky_map([] {
        photometry::Environment e{128, 64, std::vector<float>(128 * 64 * 3)};
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 128; ++x)
                for (int c = 0; c < 3; ++c)
                    e.rgb[3 * (y * 128 + x) + size_t(c)] = float(2 + photometry::direction_at(e, {x + 0.5, y + 0.5}).z);
        return e;
    }());
    EXPECT_NEAR(reference::add_sky(sky, facing_eye({1, 1, 1}, 1, 0), dvec3(0), kCentre, kView, 1).g, 3, 0.01)
        << "+Z is behind";
    EXPECT_NEAR(reference::add_sky(sky, {{}, glm::dvec4(0), {}}, dvec3(5), kCentre, kView, 1).g, 1, 0.01)
        << "-Z is ahead";
}

// The fractions are the integral of the very lobe that lamps are reflected by (shade_reference.h).
TEST(SkyReference, ReflectsUniformLightLikeTheSumOfManyLamps) {
    for (const double roughness : {0.3, 0.6, 1.0})
        for (const double nv : {0.2, 0.7, 1.0}) {
            const dvec3 v(std::sqrt(1 - nv * nv), 0, nv), f0(0.03, 0.2, 1);
            dvec3 sum(0);
            constexpr int kRows = 600;
            for (int j = 0; j < kRows; ++j)
                for (int i = 0; i < kRows; ++i) {
                    const double z = (j + 0.5) / kRows, r = std::sqrt(1 - z * z),
                                 turn = 2 * std::numbers::pi * (i + 0.5) / kRows;
                    const dvec3 l(r * std::cos(turn), r * std::sin(turn), z);
                    sum += reference::specular({0, 0, 1}, l, v, f0, roughness).value *
                           (z * 2 * std::numbers::pi / (kRows * kRows));
                }
            const photometry::Reflected fraction = photometry::specular_reflectance(nv, roughness, 4096);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(f0[c] * fraction.scale + fraction.offset, sum[c], 4e-3) << roughness << ", " << nv;
        }
}

// Codes above 1 are dielectrics, retroreflective sheets; those of measured roads reflect their colour seen flat, and
// what their roughness says of it seen steeply.
TEST(SkyReference, CodesOfMaterialsAreNotMetals) {
    const photometry::SkyMap sky = uniform(1);
    const dvec3 plain = reference::add_sky(sky, facing_eye(dvec3(0.5), 0, 0.5), dvec3(0), kCentre, kView, 1);
    for (const double code : {2.0, 5.0})
        EXPECT_EQ(reference::add_sky(sky, facing_eye(dvec3(0.5), code, 0.5), dvec3(0), kCentre, kView, 1), plain);
    EXPECT_NEAR(
        reference::add_sky(sky, facing_eye(dvec3(0.2), -2, -0.7), dvec3(0), kCentre, kView, 1 / std::numbers::pi).g,
        0.7 * 0.2, 1e-4);
}

}  // namespace
}  // namespace vesper::test::sky_reference_test
