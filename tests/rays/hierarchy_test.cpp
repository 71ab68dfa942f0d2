// The boxes: every triangle is in one leaf, within all boxes above it. SPDX-License-Identifier: MIT
#include "rays/hierarchy.h"

#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "base/budget.h"
#include "base/error.h"
#include "scene/bounds.h"

namespace vesper::test::hierarchy_test {
namespace {

using glm::vec3, rays::Node, rays::Triangle;

std::vector<Triangle> triangles_at_random(size_t count) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> at(-100, 100), size(-1, 1);
    std::vector<Triangle> triangles;
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 middle(at(random), at(random), at(random));
        Triangle t{.corners = {}, .source = i};
        for (vec3& corner : t.corners) corner = middle + vec3(size(random), size(random), size(random));
        triangles.push_back(t);
    }
    return triangles;
}

/// Visits the leaves below a node with the boxes that hold them. Returns the levels.
uint32_t visit(const std::vector<Node>& nodes, uint32_t index, const scene::Bounds& outer,
               const std::function<void(const scene::Bounds&, uint32_t, uint32_t)>& leaf) {
    uint32_t levels = 0;
    const Node& node = nodes.at(index);
    for (uint32_t i = 0; i < Node::kWidth; ++i) {
        scene::Bounds box;
        for (int axis = 0; axis < 3; ++axis)
            box.low[axis] = node.bounds[0][axis][i], box.high[axis] = node.bounds[1][axis][i];
        if (box.empty()) continue;
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(box.low, outer.low)));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(box.high, outer.high)));
        if (node.count[i] > 0)
            leaf(box, node.first[i], node.count[i]);
        else
            levels = std::max(levels, visit(nodes, node.first[i], box, leaf));
    }
    return levels + 1;
}

TEST(Hierarchy, HoldsEveryTriangleOnce) {
    for (const size_t count : {0, 1, 4, 5, 6, 17, 1000, 20000}) {
        std::vector<Triangle> triangles = triangles_at_random(count);
        const std::vector<Triangle> before = triangles;
        const std::vector<Node> nodes = rays::build_hierarchy(triangles);
        EXPECT_LE(nodes.size(), count > 4 ? (count - 2) / 3 : std::min<size_t>(count, 1)) << "the bound on memory";
        std::vector<int> seen(count), held(count);
        scene::Bounds all;
        all.add(vec3(-200)), all.add(vec3(200));
        if (nodes.empty()) {
            EXPECT_EQ(count, 0u);
            continue;
        }
        const uint32_t levels = visit(nodes, 0, all, [&](const scene::Bounds& box, uint32_t first, uint32_t number) {
            EXPECT_LE(number, rays::kLeafSize);
            for (uint32_t t = first; t < first + number; ++t) {
                ++held.at(t), ++seen.at(triangles.at(t).source);
                for (size_t k = 0; k < 3; ++k) {
                    const vec3 corner = triangles[t].corners[k];
                    EXPECT_EQ(corner, before[triangles[t].source].corners[k]);
                    EXPECT_TRUE(glm::all(glm::greaterThanEqual(corner, box.low)) &&
                                glm::all(glm::lessThanEqual(corner, box.high)));
                }
            }
        });
        EXPECT_LE(levels, count > 10000 ? 14u : 10u);
        EXPECT_EQ(seen, std::vector<int>(count, 1));
        EXPECT_EQ(held, std::vector<int>(count, 1));
    }
}

// Ever smaller triangles towards a corner: each plane between bins cuts off a few.
TEST(Hierarchy, ItsLevelsAreBounded) {
    std::vector<Triangle> triangles;
    float place = 1e7f;
    for (uint32_t i = 0; i < 4000; ++i) {
        triangles.push_back({{vec3(place), vec3(place, 0, place), vec3(place, place, 0)}, i});
        place *= i % 2 ? 0.98f : 0.979f;
    }
    const std::vector<Node> nodes = rays::build_hierarchy(triangles);
    scene::Bounds all;
    all.add(vec3(-100)), all.add(vec3(1.01e7f));
    uint32_t held = 0;
    EXPECT_LT(visit(nodes, 0, all, [&](const scene::Bounds&, uint32_t, uint32_t count) { held += count; }),
              rays::kMostLevels);
    EXPECT_EQ(held, 4000u);
}

}  // namespace
}  // namespace vesper::test::hierarchy_test
