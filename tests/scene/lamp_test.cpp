// Lamps of a scene: what closed forms say of their lobes. SPDX-License-Identifier: MIT
#include "scene/lamp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

/// Flux by numerical integration of the lobe over the sphere.
double integrated(const scene::Lamp& lamp) {
    double sum = 0;
    constexpr int kSteps = 200'000;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = std::numbers::pi * (i + 0.5) / kSteps, cosine = std::cos(angle);
        double value = 1;
        if (lamp.kind == scene::Lamp::Kind::CosinePower) value = cosine > 0 ? std::pow(cosine, lamp.exponent) : 0;
        if (lamp.kind == scene::Lamp::Kind::Spot) {
            const double outer = std::cos(lamp.outer_cone), inner = std::cos(lamp.inner_cone);
            const double ramp = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
            value = ramp * ramp;
        }
        sum += 2 * std::numbers::pi * std::sin(angle) * lamp.intensity * value * std::numbers::pi / kSteps;
    }
    return sum;
}

TEST(Lamp, FluxIsTheIntegralOfTheLobe) {
    scene::Lamp lamp;
    lamp.intensity = 100;
    EXPECT_NEAR(scene::luminous_flux(lamp), integrated(lamp), 1e-4);
    EXPECT_NEAR(scene::luminous_flux(lamp), 400 * std::numbers::pi, 1e-6);
    lamp.kind = scene::Lamp::Kind::Spot;
    lamp.inner_cone = 0.3f, lamp.outer_cone = 1.2f;
    EXPECT_NEAR(scene::luminous_flux(lamp), integrated(lamp), 1e-4);
    // Narrow cones: pi r^2 of the inner and a third of what is between, in small angles.
    lamp.inner_cone = 0.006f, lamp.outer_cone = 0.01f;
    EXPECT_NEAR(scene::luminous_flux(lamp) / (100 * std::numbers::pi * (36e-6 + (100e-6 - 36e-6) / 3)), 1, 2e-5);
    lamp.kind = scene::Lamp::Kind::CosinePower;
    for (const float exponent : {0.0f, 1.0f, 250.0f}) {
        lamp.exponent = exponent;
        EXPECT_NEAR(scene::luminous_flux(lamp), integrated(lamp), 1e-3) << exponent;
    }
}

}  // namespace
}  // namespace vesper::test
