// Casters at rest, merged and simplified: all parts once, where they are, no farther off than a level says.
// SPDX-License-Identifier: MIT
#include "gpu_scene/caster_cells.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/scene.h"

namespace vesper::test {
namespace {

using gpu_scene::CasterCell, gpu_scene::PlacedPart;

// A grid of n x n quads; `place` takes (0, 0) to (1, 1) to m.
template <class Place>
scene::Mesh grid(uint32_t n, uint32_t material, Place place) {
    scene::Primitive p;
    p.material = material;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x) {
            p.vertices.emplace_back().position = place(double(x) / n, double(y) / n);
            p.bounds.add(p.vertices.back().position);
        }
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + n + 1;
            p.indices.insert(p.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    return {"", {p}};
}
scene::Mesh square(uint32_t material) {
    return grid(1, material, [](double u, double v) { return glm::vec3(u, 0, v); });
}

void add_lamp(scene::Scene& s) {
    s.lamps.emplace_back();
    s.nodes.emplace_back().lamp = 0;
}

uint32_t add_node(scene::Scene& s, uint32_t mesh, glm::vec3 at) {
    scene::Node& node = s.nodes.emplace_back();
    node.mesh = mesh, node.translation = at;
    return uint32_t(s.nodes.size()) - 1;
}

// Corners of a level, m, world.
std::vector<glm::dvec3> corners(const CasterCell& cell, const CasterCell::Level& level) {
    std::vector<glm::dvec3> found;
    for (uint32_t i = level.first_index; i < level.first_index + level.index_count; ++i)
        found.push_back(cell.origin + glm::dvec3(cell.vertices[cell.indices[i]]));
    return found;
}

TEST(CasterCells, HoldEachOpaquePartAtRestOnce) {
    scene::Scene s;
    s.materials.resize(3);
    s.materials[1].alpha = scene::Material::Alpha::Mask;
    s.materials[2].clear = true;
    for (uint32_t material = 0; material < 3; ++material) s.meshes.push_back(square(material));
    s.meshes.push_back({"", {s.meshes[1].primitives[0], s.meshes[0].primitives[0]}});  // parts 3, masked, and 4
    for (const uint32_t mesh : {0u, 1u, 2u, 3u, 0u}) add_node(s, mesh, glm::vec3(float(s.nodes.size()), 0, 1));
    EXPECT_TRUE(gpu_scene::caster_cells(s).empty()) << "nothing casts a shadow";
    add_lamp(s);
    add_node(s, 0, {17, 0, 1});
    add_node(s, 0, {18, 0, 1});
    s.channels.push_back({.node = add_node(s, 0, {7, 0, 1}), .times = {0}, .values = {{7, 0, 1, 0}}});

    const std::vector<CasterCell> cells = gpu_scene::caster_cells(s);
    ASSERT_EQ(cells.size(), 2u);
    EXPECT_EQ(cells[0].parts, (std::vector<PlacedPart>{{0, 0}, {3, 4}, {4, 0}}));
    EXPECT_EQ(cells[1].parts, (std::vector<PlacedPart>{{5, 0}, {6, 0}}));
    ASSERT_GE(cells[0].levels.size(), 1u);
    const std::vector<glm::dvec3> found = corners(cells[0], cells[0].levels[0]);
    ASSERT_EQ(found.size(), 18u);
    for (const glm::dvec3 wanted : {glm::dvec3(0, 0, 1), {1, 0, 2}, {3, 0, 1}, {4, 0, 2}, {5, 0, 1}, {5, 0, 2}})
        EXPECT_TRUE(std::ranges::any_of(found, [&](glm::dvec3 c) { return glm::distance(c, wanted) < 1e-6; }));
    for (const glm::dvec3 c : found) EXPECT_LE(glm::distance(c, cells[0].origin), cells[0].radius + 1e-6);
}

TEST(CasterCells, APlaneBecomesTwoTriangles) {
    scene::Scene s;
    s.materials.resize(1);
    s.meshes.push_back(grid(40, 0, [](double u, double v) { return glm::vec3(60 * u, 3, 60 * v); }));
    add_node(s, 0, {1000, 0, -1000});
    add_lamp(s);
    const std::vector<CasterCell> cells = gpu_scene::caster_cells(s);
    ASSERT_EQ(cells.size(), 1u);
    ASSERT_EQ(cells[0].levels.size(), 2u);
    EXPECT_EQ(cells[0].levels[0].index_count, 3u * 3200);
    EXPECT_EQ(cells[0].levels[1].index_count, 3u * 2);
    for (const CasterCell::Level& level : cells[0].levels) {
        glm::dvec3 low(1e9), high(-1e9);
        for (const glm::dvec3 c : corners(cells[0], level)) low = glm::min(low, c), high = glm::max(high, c);
        EXPECT_LT(glm::distance(low, {1000, 3, -1000}), 1e-4);
        EXPECT_LT(glm::distance(high, {1060, 3, -940}), 1e-4);
    }
}

// A sphere of 4 m: triangles leave it by their sagittae, which are at most the error.
TEST(CasterCells, ASphereIsNoFartherOffThanItsLevelSays) {
    constexpr double kRadius = 4;
    scene::Scene s;
    s.materials.resize(1);
    s.meshes.push_back(grid(64, 0, [](double u, double v) {
        const double turn = 2 * 3.14159265358979 * u, polar = 3.14159265358979 * v;
        return glm::vec3(
            kRadius * glm::dvec3(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn)));
    }));
    add_node(s, 0, {8, 8, 8});
    add_lamp(s);
    const std::vector<CasterCell> cells = gpu_scene::caster_cells(s);
    ASSERT_EQ(cells.size(), 1u);
    ASSERT_GE(cells[0].levels.size(), 4u);
    uint32_t last = ~0u;
    for (const CasterCell::Level& level : cells[0].levels) {
        EXPECT_LT(level.index_count, last);
        last = level.index_count;
        const std::vector<glm::dvec3> at = corners(cells[0], level);
        double farthest = 0;
        for (size_t i = 0; i < at.size(); i += 3)
            for (const glm::dvec3 share : {glm::dvec3(1, 1, 1), {0, 1, 1}, {1, 0, 1}, {1, 1, 0}}) {
                const glm::dvec3 p = glm::dmat3(at[i], at[i + 1], at[i + 2]) * (share / (share.x + share.y + share.z));
                farthest = std::max(farthest, std::abs(glm::distance(p, {8, 8, 8}) - kRadius));
            }
        EXPECT_LE(farthest, level.error + 0.01);  // 1 cm: the grid's own
    }
}

}  // namespace
}  // namespace vesper::test
