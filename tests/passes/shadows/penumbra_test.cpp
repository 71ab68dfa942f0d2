// Penumbrae of lamps with a size, on the device: closed forms. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "passes/shadows/penumbra_reference.h"
#include "support/lit.h"
#include "support/occluders.h"

namespace vesper::test::penumbra_test {
namespace {

constexpr double kHeight = 6;      // of the lamp above the ground, m
constexpr uint32_t kPixels = 500;  // over 10 m of ground
constexpr double kMetres = 10;

/// One lamp of 1000 cd over the ground, and the shares of it along the picture's rows.
struct Ground {
    OccluderScene s;
    explicit Ground(double radius, float roughness = 1) {
        s.plate({0, 0, 0}, {20, 0, 0}, {0, 0, -20});
        s.scene().materials[0].roughness = roughness;
        s.scene().materials[0].base_colour = {0.8f, 0.4f, 0.2f, 1};
        scene::Lamp lamp;
        lamp.intensity = 1000, lamp.colour = {1.2f, 1, 0.3f};
        if (radius > 0) lamp.opening.length = lamp.opening.width = 2 * radius, lamp.opening.round = true;
        s.lamp(lamp, {0, kHeight, 0}, glm::angleAxis(float(-kPi / 2), glm::vec3(1, 0, 0)));
    }
    /// Calls `visit(x, z, share)` for pixels of the ground within 1.5 m of the middle along z.
    template <class Visit>
    void shares(Visit visit) {
        PassRig rig;
        Lit lit(rig, s.scene());
        const Lit::Picture p = lit.render(view_of_the_ground(kPixels, kMetres));
        for (size_t i = 0; i < p.pixels.size(); ++i) {
            const glm::dvec3 at = p.place(i, kPixels);
            if (at.z > -19.99 || at.x < 0 || std::abs(at.y) > 1.5) continue;
            reference::Shaded all;
            const glm::dvec3 normal = reference::octahedral_decode(glm::dvec2(p.surfaces[i]));
            const double roughness = double(p.surfaces[i].w);
            const glm::dvec3 base(p.colours[i]);
            reference::add_lamp(p.list.lamps.at(0), reference::kind_of(0, p.list.counts), at, normal, base / kPi,
                                reference::normal_reflectance(base, 0, roughness), roughness, 0, all);
            const glm::dvec3 share = glm::dvec3(p.pixels[i]) / all.luminance;
            for (const double other : {share.r, share.b}) EXPECT_NEAR(other, share.g, 1e-3);
            visit(at.x, -at.y, share.g);
        }
        EXPECT_EQ(rig.complaints(), "");
    }
};

// How far shares are from those of a function of x.
struct Error {
    double mean = 0, root_mean_square = 0, largest = 0;
    double spread =
        0;  // mean, counted the other way where less than half is seen: below 0 where the penumbra is too wide
    size_t pixels = 0;  // in the penumbra
};
template <class Truth>
Error error_of(Ground& ground, Truth truth) {
    Error e;
    ground.shares([&](double x, double, double share) {
        const double expected = truth(x), off = share - expected;
        if (expected > 0.001 && expected < 0.999) {
            e.mean += off, e.root_mean_square += off * off, ++e.pixels;
            e.spread += expected < 0.5 ? -off : off;
        }
        e.largest = std::max(e.largest, std::abs(off));
    });
    e.mean /= double(e.pixels), e.spread /= double(e.pixels),
        e.root_mean_square = std::sqrt(e.root_mean_square / double(e.pixels));
    return e;
}

// The edge of a plate: a disc is uncovered as x grows.
TEST(Penumbra, IsThatOfADiscPastAnEdge) {
    struct Case {
        double height, radius;  // of the edge and of the lamp, m
        double spread;          // bound of Error::spread: a tenth of the width is 0.02; what pixels and texels add
    };
    for (const Case& c : {Case{2, 0.5, 0.015}, {3, 0.3, 0.015}, {1, 0.5, 0.015}, {0.5, 1, 0.04}, {4, 0.2, 0.03}}) {
        const double height = c.height, radius = c.radius;
        SCOPED_TRACE("edge at " + std::to_string(height) + " m, radius " + std::to_string(radius) + " m");
        Ground ground(radius);
        ground.s.plate({-1, float(height), 0}, {2, 0, 0}, {0, 0, -8});
        const Error e = error_of(ground, [&](double x) { return reference::past_edge(x, 1, height, kHeight, radius); });
        EXPECT_GT(e.pixels, 1000u);
        // Of the 32 points of the disc up to three are at the same place across an edge; and shares have 4 bits.
        EXPECT_LT(std::abs(e.mean), 0.025);
        EXPECT_LT(std::abs(e.spread), c.spread);
        EXPECT_LT(e.root_mean_square, 0.08);
        EXPECT_LT(e.largest, 0.27);
    }
}

// Highlights have the share of the lamp that all of its light has.
TEST(Penumbra, GlossyGroundHasThatOfMattGround) {
    std::vector<double> matt;
    for (const float roughness : {1.0f, 0.3f}) {
        Ground ground(0.5, roughness);
        ground.s.plate({-1, 2, 0}, {2, 0, 0}, {0, 0, -8});
        std::vector<double> shares;
        ground.shares([&](double, double, double share) { shares.push_back(share); });
        if (matt.empty()) {
            matt = shares;
            continue;
        }
        ASSERT_EQ(shares.size(), matt.size());
        size_t partly = 0, off = 0;
        for (size_t i = 0; i < shares.size(); ++i) {
            partly += shares[i] > 0.1 && shares[i] < 0.9 ? 1 : 0;
            off += std::abs(shares[i] - matt[i]) > 1e-3 ? 1 : 0;
        }
        EXPECT_GT(partly, 1000u);
        EXPECT_EQ(off, 0u) << "of " << shares.size();
    }
}

// A bar that is narrower than the lamp has no umbra.
TEST(Penumbra, OfANarrowBarHasNoUmbra) {
    Ground ground(0.5);
    ground.s.plate({1, 2, 0}, {0.1f, 0, 0}, {0, 0, -8});
    const Error e = error_of(ground, [](double x) {
        return 1 - reference::past_edge(x, 0.9, 2, kHeight, 0.5) + reference::past_edge(x, 1.1, 2, kHeight, 0.5);
    });
    EXPECT_LT(std::abs(e.mean), 0.02);
    EXPECT_LT(e.root_mean_square, 0.08);
    EXPECT_LT(e.largest, 0.25);
}

// What stops the light after a sixth of its way has the penumbra of what does so after a quarter: discs that pixels
// look at have three times the lamp's radius at most.
TEST(Penumbra, IsNoWiderThanThatOfAQuarterOfTheWay) {
    constexpr double kRadius = 0.2, kEdge = 0.6;  // m; the shadow's, of an edge at 0.1 m
    Ground ground(kRadius);
    ground.s.plate({-0.4f, 5, 0}, {0.5f, 0, 0}, {0, 0, -3});
    size_t lit = 0, dimmed = 0;
    const Error e = error_of(ground, [&](double x) { return reference::disc_beyond((kEdge - x) / (3 * kRadius)); });
    ground.shares([&](double x, double, double share) {
        if (x < kEdge + 3.3 * kRadius) return;
        ++lit, dimmed += share < 1 - 1e-3 ? 1 : 0;
    });
    EXPECT_GT(e.pixels, 1000u);
    EXPECT_LT(std::abs(e.mean), 0.025);
    EXPECT_LT(std::abs(e.spread), 0.015);
    EXPECT_GT(lit, 10000u);
    EXPECT_EQ(dimmed, 0u);
}

// A lamp without a size has a hard edge, of a pixel.
TEST(Penumbra, OfAPointIsNone) {
    Ground ground(0);
    ground.s.plate({-1, 2, 0}, {2, 0, 0}, {0, 0, -8});
    size_t between = 0, pixels = 0;
    ground.shares([&](double, double, double share) {
        ++pixels;
        between += share > 0.01 && share < 0.99 ? 1 : 0;
    });
    EXPECT_GT(pixels, 10000u);
    EXPECT_LT(between, pixels / 100);
}

}  // namespace
}  // namespace vesper::test::penumbra_test
