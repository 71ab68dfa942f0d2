// Radiosity from a cache is what was given to it, and belongs to one scene. SPDX-License-Identifier: MIT
#include "transport/kept_radiosity.h"

#include <functional>

#include <gtest/gtest.h>

#include "support/rooms.h"
#include "support/shelf.h"

namespace vesper::test::kept_radiosity_test {
namespace {

std::optional<transport::Radiosity> found(Shelf& shelf, const scene::Scene& scene, bool& gathers,
                                          const std::vector<bool>& moving = {},
                                          const transport::RadiositySettings& settings = {}) {
    gathers = false;
    return transport::kept_or_gathered(scene, scene::world_transforms(scene, 0), moving, settings, &shelf,
                                       [&](double) { return gathers = true; });
}

TEST(KeptRadiosity, IsTheSame) {
    Shelf shelf;
    bool gathers = false;
    const scene::Scene scene = lit_room();
    const auto first = found(shelf, scene, gathers);
    EXPECT_TRUE(gathers);
    const auto second = found(shelf, scene, gathers);
    EXPECT_FALSE(gathers);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->numbers, second->numbers);
    EXPECT_EQ(first->met, second->met);
    EXPECT_EQ(first->beside, second->beside);
    EXPECT_EQ(first->grid.origin, second->grid.origin);
    EXPECT_EQ(first->bytes(), second->bytes());
    EXPECT_EQ(first->solve({}).other, second->solve({}).other);
    for (auto& [key, bytes] : shelf.kept) bytes.pop_back();
    found(shelf, scene, gathers);
    EXPECT_TRUE(gathers) << "what is not whole counts as none";
}

TEST(KeptRadiosity, HasBodiesThatMove) {
    Shelf shelf;
    bool gathers = false;
    scene::Scene scene = lit_room();
    const size_t first = scene.nodes.size();
    add_box(scene, 0, glm::vec3(0.5f), {0, -1, 0});
    for (size_t node = first + 1; node < scene.nodes.size(); ++node) scene.nodes[node].parent = uint32_t(first);
    std::vector<bool> moving(scene.nodes.size(), false);
    for (size_t node = first; node < moving.size(); ++node) moving[node] = true;
    const auto gathered = found(shelf, scene, gathers, moving), kept = found(shelf, scene, gathers, moving);
    EXPECT_FALSE(gathers);
    ASSERT_TRUE(gathered && kept);
    ASSERT_EQ(kept->bodies.bodies.size(), 1u);
    EXPECT_EQ(kept->bodies.bodies[0].node, first);
    ASSERT_EQ(kept->bodies.volumes.size(), 1u);
    EXPECT_EQ(kept->bodies.volumes[0].low, gathered->bodies.volumes[0].low);
    EXPECT_EQ(kept->bodies.volumes[0].count, gathered->bodies.volumes[0].count);
    EXPECT_EQ(kept->bodies.hidden, gathered->bodies.hidden);
    scene.nodes[first].translation.x = 1;
    found(shelf, scene, gathers, moving);
    EXPECT_FALSE(gathers) << "where it stands does not matter";
    scene.nodes[first + 1].translation.x = 1;
    found(shelf, scene, gathers, moving);
    EXPECT_TRUE(gathers) << "it has another shape";
}

TEST(KeptRadiosity, BelongsToOneScene) {
    Shelf shelf;
    bool gathers = false;
    found(shelf, lit_room(), gathers);
    const std::pair<const char*, std::function<void(scene::Scene&)>> changes[]{
        {"reflectance", [](scene::Scene& s) { s.materials[0].base_colour.g = 0.51f; }},
        {"emission", [](scene::Scene& s) { s.materials[1].emission.r = 11; }},
        {"sides", [](scene::Scene& s) { s.materials[1].double_sided = true; }},
        {"candela", [](scene::Scene& s) { s.lamps[0].intensity = 101; }},
        {"place", [](scene::Scene& s) { s.nodes.back().translation.y = 0.01; }},
        {"fixture", [](scene::Scene& s) { s.nodes[6].fixture.reset(); }},
        {"vertex", [](scene::Scene& s) { s.meshes[0].primitives[0].vertices[0].position.x += 0.01f; }},
        {"transfer", [](scene::Scene& s) { s.transfer.kind = scene::Transfer::Kind::Gamma; }}};
    for (const auto& [what, change] : changes) {
        scene::Scene scene = lit_room();
        change(scene);
        found(shelf, scene, gathers);
        EXPECT_TRUE(gathers) << what;
    }
    found(shelf, lit_room(), gathers, std::vector<bool>(lit_room().nodes.size(), false));
    EXPECT_FALSE(gathers) << "nothing moves";
    std::vector<bool> moving(lit_room().nodes.size(), false);
    moving.back() = true;
    found(shelf, lit_room(), gathers, moving);
    EXPECT_TRUE(gathers);
    found(shelf, lit_room(), gathers, {}, {.rays = 16});
    EXPECT_TRUE(gathers);
}

TEST(KeptRadiosity, AFullCacheChangesNothing) {
    Shelf shelf;
    shelf.full = true;
    bool gathers = false;
    EXPECT_TRUE(found(shelf, lit_room(), gathers));
    EXPECT_TRUE(gathers);
    EXPECT_TRUE(shelf.kept.empty());
}

}  // namespace
}  // namespace vesper::test::kept_radiosity_test
