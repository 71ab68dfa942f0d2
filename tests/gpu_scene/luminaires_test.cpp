// Openings of lamps in the image: what the host works out for the pass. SPDX-License-Identifier: MIT
#include "gpu_scene/luminaires.h"
#include "scene/scene.h"

#include <map>
#include <random>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/error.h"
#include "passes/luminaires_reference.h"
#include "scene/lamp.h"
#include "support/sources.h"

namespace vesper::test {
namespace {

using glm::dvec2, glm::dvec3;
using gpu_scene::LuminaireList;
using scene::Lamp;

const gpu_scene::View kView = gpu_scene::View::symmetric({1680, 1050}, 0.6f, glm::mat4(1));

std::vector<dvec2> silhouette_of(const LuminaireList& list, size_t source = 0) {
    const shared::Luminaire& s = list.luminaires.at(source);
    std::vector<dvec2> silhouette;
    for (size_t i = 0; i < size_t(s.vertices); ++i)
        silhouette.push_back(dvec2(s.origin) + dvec2(list.silhouettes[size_t(s.first) + i]));
    return silhouette;
}

/// Illuminance at the eye of one lamp: luminance times solid angle, lx.
double at_eye(const Lamp& lamp, const glm::mat4& world, std::vector<photometry::Distribution> distributions = {}) {
    Lamps lamps;
    lamps.set.distributions = std::move(distributions);
    lamps.add(lamp, world);
    const LuminaireList list = lamps.seen(kView);
    if (list.luminaires.empty()) return 0;
    const double luminance = glm::dot(dvec3(list.luminaires[0].luminance), dvec3(0.212639, 0.715169, 0.072192));
    return luminance * reference::solid_angle(kView, silhouette_of(list));
}

TEST(Luminaires, LuminanceIsIntensityOverArea) {
    Lamps lamps;
    lamps.add(lamp_with_opening(900, 0.3, 0.2), aimed({0, 0, -5}, {0, 0, 1}));
    lamps.add(lamp_with_opening(900, 0.3, 0.2, true), aimed({0, 0, -5}, {0, 0, 1}));
    lamps.add(lamp_with_opening(900, 0.3, 0.2), aimed({0, 0, -5}, {std::sqrt(3.0f), 0, 1}));  // cos 60 over cos 60
    const LuminaireList list = lamps.seen(kView);
    EXPECT_NEAR(list.luminaires.at(0).luminance.g, 900 / 0.06, 0.01);
    EXPECT_NEAR(list.luminaires.at(1).luminance.g, 900 / (0.06 * kPi / 4), 0.01);
    EXPECT_NEAR(list.luminaires.at(2).luminance.g, 900 / 0.06, 0.01);
    EXPECT_NEAR(list.luminaires.at(0).hidden, 5 * 0.999 - 0.25 - std::hypot(0.3, 0.2) / 2 - 0.1, 1e-5);
}

// A dimmed lamp is as much darker, and dazzles as much less; one that is off is not seen.
TEST(Luminaires, IsDimmedWithItsNode) {
    gpu_scene::LuminaireSet set;
    for (uint32_t node = 0; node < 3; ++node) set.lamps.push_back({lamp_with_opening(900, 0.3, 0.2), node});
    gpu_scene::SceneFrame frame{.world = std::vector<glm::dmat4>(3, aimed({0, 0, -5}, {0, 0, 1})),
                                .dimming = {1, 0.25f, 0}};
    const LuminaireList list = gpu_scene::luminaire_list(set, frame, kView);
    ASSERT_EQ(list.luminaires.size(), 2u);
    ASSERT_EQ(list.glare_sources.size(), 2u);
    EXPECT_NEAR(list.luminaires[1].luminance.g / list.luminaires[0].luminance.g, 0.25, 1e-6);
    EXPECT_NEAR(list.glare_sources[1].illuminance.g / list.glare_sources[0].illuminance.g, 0.25, 1e-6);
}

// I(direction) / d^2 for every kind of lamp, turned any way, near and far; the lamp is small against its distance.
TEST(Luminaires, HoldsTheIlluminanceOfEveryKind) {
    photometry::Distribution beam;
    beam.goniometry = photometry::Goniometry::TypeA;
    beam.horizontal = {-90, 0, 90}, beam.vertical = {-90, 0, 90};
    beam.candela = {0, 10, 5, 100, 2000, 50, 0, 30, 0};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    std::normal_distribution<float> normal;
    int drawn = 0;
    for (int k = 0; k < 400; ++k) {
        Lamp lamp =
            lamp_with_opening(300, 0.02 + 0.2 * unit(random), 0.02 + 0.2 * unit(random), k % 2 == 0, Lamp::Kind(k % 5));
        if (lamp.kind == Lamp::Kind::Directional) continue;
        lamp.inner_cone = 0.3f, lamp.outer_cone = 1.2f, lamp.distribution = 0, lamp.exponent = 2.5f;
        const float depth = 10 * std::pow(200.0f, unit(random));
        const glm::vec3 position(depth * 0.4f * (unit(random) - 0.5f), depth * 0.25f * (unit(random) - 0.5f), -depth);
        const glm::mat4 placed = aimed(position, {normal(random), normal(random), normal(random)});
        const glm::mat4 world = glm::scale(placed, glm::vec3(1 + 3 * unit(random)));
        const dvec3 eye = -dvec3(position);
        const glm::dmat3 axes(glm::normalize(dvec3(world[0])), glm::normalize(dvec3(world[1])),
                              glm::normalize(dvec3(world[2])));
        const std::vector<photometry::Distribution> distributions{beam};
        const double wanted =
            scene::luminous_intensity(lamp, distributions, glm::transpose(axes) * eye) / glm::dot(eye, eye);
        const double got = at_eye(lamp, world, distributions);
        drawn += got > 0;
        // Of second order in size over distance; a widened silhouette lies a little off the centre's solid angle.
        EXPECT_NEAR(got, wanted, 5e-4 * wanted) << "kind " << k % 5 << " at " << depth << " m";
    }
    EXPECT_GT(drawn, 150);
}

TEST(Luminaires, GrazingViewsStayFinite) {
    for (const float angle : {84.0f, 85.5f, 89.0f, 90.0f, 91.0f, 120.0f, 180.0f}) {
        Lamps lamps;
        Lamp lamp = lamp_with_opening(50, 0.2, 0.1, false, Lamp::Kind::Spot);
        lamp.inner_cone = 2.9f, lamp.outer_cone = 3.1f;  // shines backwards too, as light from a diffuse dome does
        const float a = glm::radians(angle);
        const glm::mat4 world = aimed({0, 0, -10}, {std::sin(a), 0.01f, std::cos(a)});
        lamps.add(lamp, world);
        const LuminaireList list = lamps.seen(kView);
        if (angle < 165) {
            EXPECT_NEAR(at_eye(lamp, world), 0.5, 2e-3) << angle;
            const double seen = std::max(double(std::cos(a)), gpu_scene::kGrazing);
            EXPECT_NEAR(list.luminaires.at(0).luminance.g / (50 / (0.02 * seen)), 1, 1e-3) << angle;
        } else {
            EXPECT_TRUE(list.luminaires.empty()) << "nothing shines there";
        }
    }
}

TEST(Luminaires, PointLampsFaceTheEye) {
    for (const glm::vec3 axis : {glm::vec3(0, 0, 1), {0, 0, -1}, {1, 0, 0}, {0, -1, 0.2f}}) {
        Lamps lamps;
        lamps.add(lamp_with_opening(80, 0.3, 0.3, true, Lamp::Kind::Point), aimed({1, 0.5f, -20}, axis));
        EXPECT_NEAR(lamps.seen(kView).luminaires.at(0).luminance.g, 80 / (0.09 * kPi / 4), 0.01);
    }
}

TEST(Luminaires, SmallOnesAreWidenedToAPixel) {
    Lamps lamps;
    lamps.add(lamp_with_opening(80, 0.1, 0.1), aimed({0, 0, -1000}, {0, 0, 1}));
    lamps.add(lamp_with_opening(80, 3, 0.01), aimed({0, 0, -100}, {0, 0, 1}));
    const LuminaireList list = lamps.seen(kView);
    const auto extent = [&](size_t source) {
        dvec2 low(1e9), high(-1e9);
        for (const dvec2 v : silhouette_of(list, source)) low = glm::min(low, v), high = glm::max(high, v);
        return high - low;
    };
    EXPECT_NEAR(extent(0).x, 1, 1e-5);
    EXPECT_NEAR(extent(0).y, 1, 1e-5);
    EXPECT_NEAR(extent(1).x, 0.03 / double(kView.ray_scale().x), 1e-3);
    EXPECT_NEAR(extent(1).y, 1, 1e-5);
}

TEST(Luminaires, WhatCannotBeSeenIsLeftOut) {
    const auto sources = [](const Lamp& lamp, const glm::mat4& world) {
        Lamps lamps;
        lamps.add(lamp, world);
        return lamps.seen(kView).luminaires.size();
    };
    const Lamp lamp = lamp_with_opening(80, 0.2, 0.2);
    EXPECT_EQ(sources(lamp, aimed({0, 0, -10}, {0, 0, 1})), 1u);
    EXPECT_EQ(sources(lamp, aimed({0, 0, -10}, {0, 0, -1})), 0u) << "it shines away";
    EXPECT_EQ(sources(lamp, aimed({0, 0, 10}, {0, 0, -1})), 0u) << "it is behind the eye";
    EXPECT_EQ(sources(lamp, aimed({20, 0, -10}, {0, 0, 1})), 0u) << "it is beside the image";
    EXPECT_EQ(sources(lamp, aimed({0, 0, -0.05f}, {0, 0, 1})), 0u) << "it is nearer than the near plane";
    EXPECT_EQ(sources(lamp, glm::mat4(0)), 0u) << "it has no place";
    EXPECT_EQ(sources(lamp, glm::scale(aimed({0, 0, -10}, {0, 0, 1}), {1, 0, 1})), 0u) << "its node is flat";

    Lamp hidden = lamp;
    hidden.opening.drawn = false;
    EXPECT_EQ(sources(hidden, aimed({0, 0, -10}, {0, 0, 1})), 0u) << "a surface shows it";

    scene::Scene scene;
    scene.lamps = {lamp, lamp_with_opening(80, 0, 0), lamp_with_opening(80, 1, 1, false, Lamp::Kind::Directional)};
    for (uint32_t i = 0; i < 3; ++i) scene.nodes.emplace_back().lamp = i;
    EXPECT_EQ(gpu_scene::placed_luminaires(scene).lamps.size(), 2u) << "a sun has no place";
}

// It comes in without a step: half of it at the edge, a quarter in a corner.
TEST(Luminaires, LampsWithoutOpeningComeInGradually) {
    const double edge = double(kView.tangent_high.x), top = double(kView.tangent_high.y);
    for (const auto& [x, y, inside] :
         {std::tuple{-0.3, 0.0, 1.0}, {0.0, 0.0, 0.5}, {-0.1, 0.0, 0.75}, {0.3, 0.0, 0.0}, {0.0, 10 * top, 0.25}}) {
        Lamps lamps;
        lamps.add(lamp_with_opening(90, 0, 0, false, Lamp::Kind::Point),
                  aimed({float(10 * edge + x), float(y), -10}, {0, 0, 1}));
        const LuminaireList list = lamps.seen(kView);
        ASSERT_EQ(list.glare_sources.size(), 1u);
        EXPECT_NEAR(list.glare_sources[0].inside, inside, 1e-5) << x << " " << y;
    }
}

// Without opening: nothing is drawn, but beside the picture it dazzles with I / d^2, as it does with one.
TEST(Luminaires, LampsWithoutOpeningDazzleAsPoints) {
    for (const Lamp::Kind kind : {Lamp::Kind::Point, Lamp::Kind::CosinePower}) {
        Lamps lamps;
        for (const double side : {0.0, 0.2})
            for (const glm::vec3 at : {glm::vec3(0, 0, -10), {20, 3, -10}, {1, 0, 10}})
                lamps.add(lamp_with_opening(90, side, side, false, kind), aimed(at, -at));
        const LuminaireList list = lamps.seen(kView);
        EXPECT_EQ(list.luminaires.size(), 1u);
        ASSERT_EQ(list.glare_sources.size(), 4u);
        for (size_t i = 0; i < 2; ++i) {
            const gpu_scene::GlareSource &point = list.glare_sources[i], &opening = list.glare_sources[i + 2];
            EXPECT_EQ(point.node, i);
            EXPECT_EQ(point.inside, i == 0 ? 1 : 0);
            EXPECT_EQ(opening.inside, point.inside);
            EXPECT_LT(glm::distance(point.direction, opening.direction), 1e-12);
            EXPECT_NEAR(
                point.illuminance.g,
                90 / glm::dot(dvec3(i == 0 ? 0 : 20, i == 0 ? 0 : 3, 10), dvec3(i == 0 ? 0 : 20, i == 0 ? 0 : 3, 10)),
                1e-6);
            EXPECT_EQ(point.illuminance, opening.illuminance);
        }
    }
}

TEST(Luminaires, MoreThanTheShaderCanLookAtIsAnError) {
    Lamps lamps;
    for (int i = 0; i < 3000; ++i) lamps.add(lamp_with_opening(900, 0.3, 0.2), aimed({0, 0, -5}, {0, 0, 1}));
    EXPECT_NO_THROW(lamps.seen(kView));
    for (int i = 0; i < 3000; ++i) lamps.add(lamp_with_opening(900, 0.3, 0.2), aimed({0, 0, -5}, {0, 0, 1}));
    EXPECT_THROW(lamps.seen(kView), Error);
}

TEST(Luminaires, TheLdrBaselineDrawsWhite) {
    Lamps lamps;
    Lamp red = lamp_with_opening(80, 0.4, 0.4);
    red.colour = {4, 0.2f, 0.1f};
    lamps.add(red, aimed({0, 0, -10}, {0, 0, 1}));
    EXPECT_NEAR(lamps.seen(kView, 1.0f).luminaires.at(0).luminance.r, 1, 1e-6);
    EXPECT_NEAR(lamps.seen(kView, 1.0f).luminaires.at(0).luminance.g, 0.05, 1e-6);
}

// Every tile that a silhouette touches lists it, in order; those it covers say so.
TEST(Luminaires, TilesListWhatTouchesThem) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(0, 1);
    std::normal_distribution<float> normal;
    Lamps lamps;
    for (int i = 0; i < 60; ++i) {
        const float depth = 0.3f * std::pow(500.0f, unit(random));
        lamps.add(lamp_with_opening(80, unit(random), unit(random), i % 2 == 0, Lamp::Kind(i % 2 ? 2 : 0)),
                  aimed({0.6f * depth * (unit(random) - 0.5f), 0.4f * depth * (unit(random) - 0.5f), -depth},
                        {normal(random), normal(random), 1 + normal(random)}));
    }
    const gpu_scene::View view = gpu_scene::View::symmetric({203, 121}, 0.4f, glm::mat4(1));
    const LuminaireList list = lamps.seen(view);
    ASSERT_GT(list.luminaires.size(), 20u);
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> lists;
    for (const glm::uvec4& tile : list.tiles)
        lists[{tile.x, tile.y}].assign(list.entries.begin() + tile.z, list.entries.begin() + tile.z + tile.w);
    constexpr uint32_t kTile = shared::kLuminaireTile;
    size_t covered = 0;
    for (uint32_t row = 0; row * kTile < view.extent.height; ++row)
        for (uint32_t column = 0; column * kTile < view.extent.width; ++column) {
            const auto& entries = lists[{column, row}];
            for (size_t i = 1; i < entries.size(); ++i)
                EXPECT_LT(entries[i - 1] & ~shared::kCoversTile, entries[i] & ~shared::kCoversTile);
            for (uint32_t s = 0; s < list.luminaires.size(); ++s) {
                double area = 0;
                for (uint32_t y = 0; y < kTile; ++y)
                    for (uint32_t x = 0; x < kTile; ++x)
                        area += reference::area_within(silhouette_of(list, s), column * kTile + x, row * kTile + y);
                const bool plain = std::count(entries.begin(), entries.end(), s);
                const bool whole = std::count(entries.begin(), entries.end(), s | shared::kCoversTile);
                if (area > 1e-6) {
                    EXPECT_TRUE(plain || whole) << column << ", " << row;
                }
                if (whole) {
                    EXPECT_NEAR(area, kTile * kTile, 1e-3);
                }
                covered += whole;
            }
        }
    EXPECT_GT(covered, 100u);
}

}  // namespace
}  // namespace vesper::test
