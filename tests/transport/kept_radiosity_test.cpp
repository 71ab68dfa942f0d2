// Radiosity from a cache is what was given to it, and belongs to one scene. SPDX-License-Identifier: MIT
#include "transport/kept_radiosity.h"

#include <cmath>
#include <cstring>
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

// Numbers that others wrote, with a digest that fits, count as none.
TEST(KeptRadiosity, TakesNoNumbersThatLeadElsewhere) {
    using transport::Radiosity;
    Shelf shelf;
    bool gathers = false;
    const scene::Scene scene = lit_room();
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const auto whole = found(shelf, scene, gathers);
    ASSERT_TRUE(whole && whole->cells() > 2 && !whole->sources.empty() && !whole->met.empty());
    const Digest::Value key = transport::radiosity_key(scene, world, {}, {});
    const std::pair<const char*, std::function<void(Radiosity&)>> forgeries[]{
        {"no cells in the grid", [](Radiosity& r) { r.grid.count = glm::uvec3(0); }},
        {"a flat grid", [](Radiosity& r) { r.grid.count.z = 0; }},
        {"a grid of too many cells", [](Radiosity& r) { r.grid.count = glm::uvec3(4096); }},
        {"a grid beyond 64 bits", [](Radiosity& r) { r.grid.count = glm::uvec3(~0u); }},
        {"cubes of no size", [](Radiosity& r) { r.grid.size = 0; }},
        {"cubes of NaN", [](Radiosity& r) { r.grid.size = NAN; }},
        {"a grid nowhere", [](Radiosity& r) { r.grid.origin.y = INFINITY; }},
        {"a cell beyond the grid", [](Radiosity& r) { r.numbers.back() = ~0u; }},
        {"cells out of order", [](Radiosity& r) { r.numbers[1] = r.numbers[0]; }},
        {"heights", [](Radiosity& r) { r.heights.pop_back(); }},
        {"a height", [](Radiosity& r) { r.heights[0] = NAN; }},
        {"an area", [](Radiosity& r) { r.areas[0] = -1; }},
        {"a normal", [](Radiosity& r) { r.normals[0].x = 100; }},
        {"a reflectance", [](Radiosity& r) { r.reflectances[0].y = 100; }},
        {"sky", [](Radiosity& r) { r.sky[0] = 100; }},
        {"no sky", [](Radiosity& r) { r.sky.clear(); }},
        {"a source beyond the scene", [](Radiosity& r) { r.sources[0].node = 999; }},
        {"a source that is no lamp", [](Radiosity& r) { r.sources[0].node ^= Radiosity::kLamp; }},
        {"first sources", [](Radiosity& r) { r.first_source[1] = ~0u; }},
        {"end of sources", [](Radiosity& r) { r.first_source.back() += 1; }},
        {"no first sources", [](Radiosity& r) { r.first_source.clear(); }},
        {"first met", [](Radiosity& r) { r.first_met[0] = 1; }},
        {"end of met", [](Radiosity& r) { r.first_met.back() = ~0u; }},
        {"met", [](Radiosity& r) { r.met[0] = uint32_t(r.cells()); }},
        {"parts", [](Radiosity& r) { r.parts.pop_back(); }},
        {"a part", [](Radiosity& r) { r.parts[0] = 0x7e00; }},
        {"a cell beside", [](Radiosity& r) { r.beside[3] = ~0u; }},
        {"cells beside", [](Radiosity& r) { r.beside.pop_back(); }},
        {"walls", [](Radiosity& r) { r.walls.assign(1, 0); }},
        {"steps", [](Radiosity& r) { r.steps.assign(1, 0); }},
        {"cuts", [](Radiosity& r) { r.cuts.assign(1, {}); }},
        {"a body without a volume",
         [](Radiosity& r) {
             r.bodies.bodies = {{0, 0}};
         }},
        {"a volume without places",
         [](Radiosity& r) { r.bodies.volumes = {{.step = 1, .count = glm::uvec3(2), .first = 0}}; }},
        {"an empty volume", [](Radiosity& r) { r.bodies.volumes = {{.step = 1, .count = glm::uvec3(0)}}; }},
        {"a volume beyond 32 bits", [](Radiosity& r) {
             r.bodies.volumes = {{.step = 1, .count = {65536, 65536, 1}}};
             r.bodies.hidden.resize(8);
         }}};
    for (const auto& [what, forge] : forgeries) {
        Radiosity forged = *whole;
        forge(forged);
        transport::write_radiosity(shelf, key, forged);
        const auto got = found(shelf, scene, gathers);
        EXPECT_TRUE(gathers) << what;
        ASSERT_TRUE(got) << what;
        EXPECT_EQ(got->numbers, whole->numbers) << what;
    }
    // Lists that a header makes larger than the file, up to sizes that overflow.
    found(shelf, scene, gathers);
    ASSERT_FALSE(gathers);
    for (const uint64_t size : {uint64_t{50'000'000'000}, uint64_t{1} << 62u, ~uint64_t{0}}) {
        for (size_t list = 0; list < 18; ++list) {
            std::vector<std::byte>& header = shelf.kept.at(key);
            const std::vector<std::byte> before = header;
            std::memcpy(&header[48 + 8 * list], &size, sizeof size);
            EXPECT_FALSE(transport::read_radiosity(shelf, key)) << list << " of " << size;
            shelf.kept.at(key) = before;
        }
    }
    EXPECT_TRUE(transport::read_radiosity(shelf, key));
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
