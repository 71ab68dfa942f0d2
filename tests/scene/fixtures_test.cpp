// Which meshes belong to the fixture of a lamp. SPDX-License-Identifier: MIT
#include "scene/fixtures.h"

#include <gtest/gtest.h>

#include "support/occluders.h"

namespace vesper::test::fixtures_test {
namespace {

using Nodes = std::vector<uint32_t>;

Nodes fixture_of(const scene::Scene& scene, uint32_t lamp) {
    const Nodes lamps{lamp};
    return scene::fixture_nodes(scene, lamps, scene::world_transforms(scene, 0)).at(0);
}

/// Nodes: 0 a wall; 1 a pole with 2 its housing, 3 the lamp below the housing; 4 a lamp of its own.
scene::Scene street() {
    OccluderScene made;
    made.plate({0, 0, -5}, {5, 0, 0}, {0, 5, 0});
    const uint32_t pole = made.box({0, 4, 0}, {0.1f, 4, 0.1f}), housing = made.box({0, 0, 0}, {0.3f, 0.1f, 0.3f});
    const uint32_t lamp = made.lamp({}, {0, -0.2, 0});
    made.lamp({}, {30, 8, 0});
    scene::Scene scene = made.scene();
    scene.nodes[housing].parent = pole, scene.nodes[housing].translation = {1, 8, 0};
    scene.nodes[lamp].parent = housing;
    return scene;
}

TEST(Fixtures, AreTheMeshesBelowTheNearestNodeThatHasAny) {
    scene::Scene scene = street();
    EXPECT_EQ(fixture_of(scene, 3), Nodes{2}) << "the housing; the pole is above it";
    EXPECT_EQ(fixture_of(scene, 4), Nodes{}) << "nothing above it has a mesh";
    scene.nodes[3].parent = 1;  // beside the housing, below the pole
    EXPECT_EQ(fixture_of(scene, 3), (Nodes{1, 2}));
    scene.nodes[4].mesh = 0;
    EXPECT_EQ(fixture_of(scene, 4), Nodes{4}) << "a mesh at its own node";
}

TEST(Fixtures, AreSmall) {
    scene::Scene scene = street();
    scene.nodes[3].parent = 1;
    scene.nodes[2].translation = {19, 8, 0};
    scene.nodes[3].translation = {0, 8, 0};
    EXPECT_EQ(fixture_of(scene, 3), (Nodes{1, 2}));
    scene.nodes[2].translation.x = 20.2;
    EXPECT_EQ(fixture_of(scene, 3), Nodes{}) << "a node that holds a whole street is no fixture";
    scene.nodes[2].translation = {0, 8, 0}, scene.nodes[2].scale = {500, 1, 500};
    EXPECT_EQ(fixture_of(scene, 3), Nodes{}) << "nor one that holds the ground, in whose middle the lamp stands";
}

TEST(Fixtures, AreStatedByTheNode) {
    scene::Scene scene = street();
    scene.nodes[3].fixture = scene::kNone;
    EXPECT_EQ(fixture_of(scene, 3), Nodes{}) << "its own housing hides it";
    scene.nodes[3].fixture = 1;
    EXPECT_EQ(fixture_of(scene, 3), (Nodes{1, 2}));
    scene.nodes[0].translation = {0, 0, -100};
    scene.nodes[3].fixture = 0;
    EXPECT_EQ(fixture_of(scene, 3), Nodes{0}) << "however far away";
    scene.nodes[3].fixture = 4;
    EXPECT_EQ(fixture_of(scene, 3), Nodes{}) << "a node without meshes";
}

TEST(Fixtures, AreFoundForSeveralLampsAtOnce) {
    const scene::Scene scene = street();
    const Nodes lamps{4, 3, 3};
    const auto found = scene::fixture_nodes(scene, lamps, scene::world_transforms(scene, 0));
    EXPECT_EQ(found, (std::vector<Nodes>{{}, {2}, {2}}));
    EXPECT_TRUE(scene::fixture_nodes(scene, {}, {}).empty());
}

}  // namespace
}  // namespace vesper::test::fixtures_test
