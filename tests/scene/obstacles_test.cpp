// Obstacles by name. SPDX-License-Identifier: MIT
#include "scene/obstacles.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/rooms.h"

namespace vesper::test {
namespace {

/// "people" above "person_1" (with a mesh, and a "hat" below it) and "person_2"; a "post" twice; an empty node.
scene::Scene street() {
    scene::Scene s;
    const uint32_t material = add_material(s, 0.5f);
    const auto mesh = [&](const char* name, uint32_t parent, float at) {
        add_rectangle(s, material, {at, 0, 0}, {1, 0, 0}, {0, 2, 0});
        s.nodes.back().name = name, s.nodes.back().parent = parent;
        return uint32_t(s.nodes.size() - 1);
    };
    s.nodes.emplace_back().name = "people";
    const uint32_t first = mesh("person_1", 0, 3);
    mesh("hat", first, 4), mesh("person_2", 0, 5);
    mesh("post", scene::kNone, 6), mesh("post", scene::kNone, 7);
    s.nodes.emplace_back().name = "empty";
    return s;
}

std::vector<std::string> names_of(const std::vector<scene::Obstacle>& found) {
    std::vector<std::string> names;
    for (const scene::Obstacle& o : found) names.push_back(o.name + " " + std::to_string(o.parts.size()));
    return names;
}

TEST(Obstacles, AreNodesThatMatch) {
    const scene::Scene s = street();
    const auto find = [&](std::vector<std::string> patterns) {
        return names_of(scene::find_obstacles(s, patterns, "--obstacle"));
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(find({"people"}), (Names{"people 3"})) << "with all below it";
    EXPECT_EQ(find({"p*_?", "people/person_1"}), (Names{"person_1 2", "person_2 1"}));
    EXPECT_EQ(find({"pe*"}), (Names{"person_1 2", "person_2 1"})) << "nothing is left of the people";
    EXPECT_EQ(find({"hat", "person_1"}), (Names{"person_1 1", "hat 1"})) << "a mesh belongs to one";
    EXPECT_EQ(find({"post"}), (Names{"post 1", "post#2 1"}));
    EXPECT_EQ(find({}), Names{});
    const scene::Bounds box = scene::find_obstacles(s, {"hat"}, "")[0].parts[0].bounds;
    EXPECT_EQ(box.low, glm::vec3(4, 0, 0));
    EXPECT_EQ(box.high, glm::vec3(5, 2, 0));
}

std::string refusal(const scene::Scene& s, const std::string& pattern) {
    try {
        scene::find_obstacles(s, {pattern}, "--obstacle");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Obstacles, WhatIsNotThereIsNamed) {
    scene::Scene s = street();
    EXPECT_EQ(refusal(s, "cat\n*"), "--obstacle cat?*: no node of the scene that has surfaces matches it");
    EXPECT_NE(refusal(s, "empty"), "");
    for (int i = 0; i < 64; ++i) {
        s.nodes.push_back(s.nodes[1]);
        s.nodes.back().name = "crowd", s.nodes.back().parent = scene::kNone;
    }
    EXPECT_EQ(refusal(s, "crowd"), "");
    EXPECT_EQ(refusal(s, "*"), "--obstacle: 69 nodes match, and at most 64 can be watched");
}

}  // namespace
}  // namespace vesper::test
