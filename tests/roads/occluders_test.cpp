// What hides luminaires of a road: against planes, with sums over the luminaires that are left.
// SPDX-License-Identifier: MIT
#include "roads/occluders.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "roads/road_lighting.h"
#include "support/occluders.h"

namespace vesper::test::road_occluders_test {
namespace {

using glm::dvec3, roads::LoadedLayout, roads::Occluders, roads::RoadLighting;

/// A point of a layout in the world, by the words of layout_scene.h: ahead is -Z, left is -X.
glm::vec3 world_of(dvec3 p) { return {-p.y, p.z, -p.x}; }

/// A wall across the road at x, from one height to another, as wide as asked.
void add_wall(OccluderScene& scene, double x, double low, double high, double half_width = 200) {
    scene.plate(world_of({x, 0, (low + high) / 2}), world_of({0, half_width, 0}), world_of({0, 0, (high - low) / 2}));
}

/// Luminaires of 1000 cd to all sides, 8 m high, over a road with the table R3.
LoadedLayout plain_road() {
    LoadedLayout layout{{.name = "test"}};
    layout.distribution = {.name = "isotropic", .horizontal = {0}, .vertical = {0, 180}, .candela = {1000, 1000}};
    layout.surface = photometry::find_reflection_table("R3");
    return layout;
}

RoadLighting behind(OccluderScene& scene) {
    LoadedLayout layout = plain_road();
    layout.hiding = std::make_shared<const Occluders>(scene.scene());
    return roads::calculate_lighting(layout);
}

TEST(RoadOccluders, HideWhatIsBehindThem) {
    OccluderScene scene;
    add_wall(scene, 10, 3, 20, 5);
    const Occluders occluders(scene.scene());
    EXPECT_TRUE(occluders.hide({0, 0, 8}, {17, 0, 0})) << "3.3 m high at the wall";
    EXPECT_FALSE(occluders.hide({0, 0, 8}, {15, 0, 0})) << "2.7 m high";
    EXPECT_FALSE(occluders.hide({0, 0, 8}, {5, 0, 0}));
    EXPECT_FALSE(occluders.hide({0, 6, 8}, {20, 6, 0})) << "beside it";
    EXPECT_TRUE(occluders.hide({30, 0, 8}, {-60, 1.75, 1.5})) << "from an eye, too";
}

TEST(RoadOccluders, KerbsAndPavementsHideNothing) {
    OccluderScene scene;
    scene.plate({0, 0.15f, 0}, {50, 0, 0}, {0, 0, 200});  // a pavement everywhere
    add_wall(scene, 10, 0, 0.24);
    EXPECT_FALSE(Occluders(scene.scene()).hide({0, 0, 8}, {10.1, 0, 0}));
    add_wall(scene, 10, 0.24, 0.4);
    EXPECT_TRUE(Occluders(scene.scene()).hide({0, 0, 8}, {10.4, 0, 0}));
}

TEST(RoadOccluders, ALuminaireIsNotHiddenByItsFixture) {
    OccluderScene scene;
    scene.box(world_of({0, 0, 8}), {0.2f, 0.1f, 0.2f});
    EXPECT_FALSE(Occluders(scene.scene()).hide({0, 0, 8}, {15, 2, 0})) << "a housing without a lamp";
    const uint32_t arm = scene.box(world_of({1, 0, 7.6}), {0.2f, 0.2f, 0.2f});
    const uint32_t lamp = scene.lamp({}, {0, 0.4, 1});  // below the arm's node, at (0, 0, 8) of the layout
    EXPECT_TRUE(Occluders(scene.scene()).hide({0, 0, 8}, {16, 0, 0}));
    scene.scene().nodes[lamp].parent = arm;
    EXPECT_TRUE(Occluders(scene.scene()).hide({0, 0, 8}, {16, 0, 0})) << "a lamp somewhere else";
    scene.scene().nodes[lamp].translation = dvec3(world_of({0, 0, 7.5}));
    EXPECT_FALSE(Occluders(scene.scene()).hide({0, 0, 8}, {16, 0, 0})) << "its own";
    EXPECT_TRUE(Occluders(scene.scene()).hide({-30, 0, 23.3}, {16, 0, 0})) << "hides others";
}

TEST(RoadOccluders, NoneLeaveEveryFigureAsItIs) {
    OccluderScene scene;
    add_wall(scene, -2000, 0, 50);
    const RoadLighting without = roads::calculate_lighting(plain_road()), with = behind(scene);
    EXPECT_EQ(without.pairs, 0u);
    EXPECT_GT(with.pairs, 0u);
    EXPECT_EQ(with.hidden_pairs, 0u);
    for (size_t i = 0; i < with.points.size(); ++i) {
        EXPECT_EQ(with.points[i].illuminance, without.points[i].illuminance);
        EXPECT_EQ(with.points[i].luminance, without.points[i].luminance);
    }
    EXPECT_EQ(with.threshold_increment_percent, without.threshold_increment_percent);
    EXPECT_EQ(with.edge_ratio, without.edge_ratio);
    EXPECT_EQ(with.longitudinal_uniformity, without.longitudinal_uniformity);
}

// A wall across the middle of the field: each point has the luminaires on its side, and those it sees at less than the
// height of a kerb.
TEST(RoadOccluders, AWallLeavesEachSideItsLuminaires) {
    OccluderScene scene;
    add_wall(scene, 15, 0, 50);
    const RoadLighting result = behind(scene);
    const LoadedLayout layout = plain_road();
    const auto lamps = roads::placed_luminaires(layout, -40, 600);
    size_t pairs = 0, hidden = 0;
    for (const roads::FieldPoint& point : result.points) {
        std::vector<roads::PlacedLuminaire> left;
        for (const roads::PlacedLuminaire& lamp : lamps) {
            const double ahead = lamp.position.x - point.x;  // 8 m high: 40 m before to 96 m beyond
            const bool counts = ahead >= -40 && ahead <= 96, same = (lamp.position.x < 15) == (point.x < 15);
            const bool sees = same || 8 * std::abs(15 - point.x) < Occluders::kKerb * std::abs(ahead);
            pairs += counts, hidden += counts && !sees;
            if (sees) left.push_back(lamp);
        }
        const glm::dvec2 at(point.x, point.y);
        EXPECT_EQ(point.illuminance, roads::horizontal_illuminance(layout, left, at));
        for (size_t o = 0; o < 2; ++o)
            EXPECT_EQ(point.luminance[o], roads::luminance_towards(layout, left, at, {-60, o ? 5.25 : 1.75}));
    }
    EXPECT_EQ(result.pairs, pairs);
    EXPECT_EQ(result.hidden_pairs, hidden);
    EXPECT_GT(hidden, pairs / 4);
    EXPECT_LT(hidden, pairs);
    const RoadLighting without = roads::calculate_lighting(layout);
    EXPECT_LT(result.average_luminance, 0.9 * without.average_luminance);
}

// A wall across the road, 45 m on: the eye sees the luminaires before it.
TEST(RoadOccluders, HiddenLuminairesDoNotDazzle) {
    OccluderScene scene;
    add_wall(scene, 45, 0, 50);
    const RoadLighting result = behind(scene);
    const LoadedLayout layout = plain_road();
    for (const roads::LaneObserver& o : result.observers) {
        double worst = 0;
        for (int i = 0; i < 10; ++i) {
            const double x = -2.75 * 6.5 + 3 * i;
            worst = std::max(
                worst, roads::veiling_luminance(layout, roads::placed_luminaires(layout, 0, 45), {x, o.eye.y, 1.5}));
        }
        EXPECT_DOUBLE_EQ(o.veil, worst);
    }
    const RoadLighting without = roads::calculate_lighting(layout);
    EXPECT_LT(result.observers[0].veil, 0.9 * without.observers[0].veil);
}

TEST(RoadOccluders, TheStripsBesideTheRoadAreHiddenToo) {
    OccluderScene scene;
    // Along the right edge, behind the luminaires.
    scene.plate(world_of({0, -0.4, 10}), world_of({600, 0, 0}), world_of({0, 0, 10}));
    const RoadLighting result = behind(scene);
    EXPECT_EQ(result.edge_ratio_right, 0);
    EXPECT_EQ(result.edge_ratio_left, roads::calculate_lighting(plain_road()).edge_ratio_left);
    EXPECT_EQ(result.edge_ratio, 0);
}

}  // namespace
}  // namespace vesper::test::road_occluders_test
