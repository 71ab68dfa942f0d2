// Cells of casters from the cache: the same, of this scene and of no other. SPDX-License-Identifier: MIT
#include "gpu_scene/kept_cells.h"

#include <gtest/gtest.h>

#include "gpu_scene/occluders.h"
#include "scene/scene.h"
#include "support/shelf.h"

namespace vesper::test {
namespace {

using gpu_scene::CasterCell;

// A lamp, and sheets of 8 x 8 quads side by side.
scene::Scene lit_sheets(uint32_t count) {
    scene::Scene s;
    s.materials.emplace_back();
    scene::Primitive& p = s.meshes.emplace_back().primitives.emplace_back();
    for (uint32_t i = 0; i < 81; ++i) {
        p.vertices.emplace_back().position = {float(i % 9), 0, float(i / 9)};
        p.bounds.add(p.vertices.back().position);
        if (i % 9 < 8 && i / 9 < 8) p.indices.insert(p.indices.end(), {i, i + 1, i + 9, i + 9, i + 1, i + 10});
    }
    s.lamps.emplace_back();
    s.nodes.emplace_back().lamp = 0;
    for (uint32_t i = 0; i < count; ++i) {
        scene::Node& node = s.nodes.emplace_back();
        node.mesh = 0, node.translation = {10.0f * float(i), 0, 1};
    }
    return s;
}

std::vector<CasterCell> kept(const scene::Scene& s, Cache* cache) {
    return gpu_scene::kept_or_made_cells(s, gpu_scene::occluder_digest(s), cache);
}

void expect_same(const std::vector<CasterCell>& found, const std::vector<CasterCell>& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (size_t i = 0; i < found.size(); ++i) {
        const CasterCell &a = found[i], &b = wanted[i];
        EXPECT_EQ(a.parts, b.parts);
        EXPECT_EQ(a.origin, b.origin);
        EXPECT_EQ(a.vertices, b.vertices);
        EXPECT_EQ(a.indices, b.indices);
        EXPECT_EQ(a.radius, b.radius);
        ASSERT_EQ(a.levels.size(), b.levels.size());
        for (size_t k = 0; k < a.levels.size(); ++k) {
            EXPECT_EQ(a.levels[k].error, b.levels[k].error);
            EXPECT_EQ(a.levels[k].first_index, b.levels[k].first_index);
            EXPECT_EQ(a.levels[k].index_count, b.levels[k].index_count);
        }
    }
}

TEST(KeptCells, AreThoseOfTheScene) {
    const scene::Scene s = lit_sheets(5);
    const std::vector<CasterCell> made = gpu_scene::caster_cells(s);
    ASSERT_GE(made.size(), 2u);
    ASSERT_GE(made[0].levels.size(), 2u);
    Shelf shelf;
    expect_same(kept(s, nullptr), made);
    expect_same(kept(s, &shelf), made);
    EXPECT_EQ(shelf.kept.size(), 2u);
    expect_same(kept(s, &shelf), made);
}

TEST(KeptCells, AreReadAndNotMade) {
    const scene::Scene s = lit_sheets(5);
    Shelf shelf;
    const std::vector<CasterCell> made = kept(s, &shelf);
    for (auto& [key, bytes] : shelf.kept)
        if (bytes.size() > 16) bytes[0] ^= std::byte{1};  // of the first origin
    std::vector<CasterCell> found = kept(s, &shelf);
    EXPECT_NE(found.at(0).origin.x, made[0].origin.x);
    found[0].origin = made[0].origin;
    expect_same(found, made);
}

TEST(KeptCells, ThoseThatAreTooFewAreMadeAgain) {
    const scene::Scene s = lit_sheets(5);
    for (const int more : {-1, 1}) {
        Shelf shelf;
        const std::vector<CasterCell> made = kept(s, &shelf);
        for (auto& [key, bytes] : shelf.kept)
            if (bytes.size() == 16) bytes[0] = std::byte(int(bytes[0]) + more);  // how many there are
        expect_same(kept(s, &shelf), made);
    }
}

TEST(KeptCells, AFullCacheIsLeftAlone) {
    Shelf shelf;
    shelf.full = true;
    EXPECT_FALSE(kept(lit_sheets(5), &shelf).empty());
    EXPECT_TRUE(shelf.kept.empty());
}

TEST(KeptCells, AreOfOneSceneAlone) {
    const scene::Scene s = lit_sheets(5);
    const auto key = [](const scene::Scene& of) { return gpu_scene::cells_key(of, gpu_scene::occluder_digest(of)); };
    scene::Scene other = s;
    other.name = "a name", other.lamps[0].intensity = 7;
    EXPECT_EQ(key(other), key(s)) << "neither is in a cell";
    other.nodes[2].translation.y += 0.001f;
    EXPECT_NE(key(other), key(s));
    other = s, other.meshes[0].primitives[0].vertices[3].position.y = 0.001f;
    EXPECT_NE(key(other), key(s));
    other = s, other.nodes[0].lamp = scene::kNone;
    EXPECT_NE(key(other), key(s));
    other = s, other.channels.push_back({.node = 2, .times = {0}, .values = {{0, 0, 0, 0}}});
    EXPECT_NE(key(other), key(s));
}

}  // namespace
}  // namespace vesper::test
