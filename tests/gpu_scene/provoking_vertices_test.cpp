// Triangles that one vertex tells apart. SPDX-License-Identifier: MIT
#include "gpu_scene/provoking_vertices.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace vesper::test::provoking_vertices_test {
namespace {

scene::Primitive made_of(size_t vertices, std::vector<uint32_t> indices) {
    scene::Primitive primitive;
    primitive.vertices.resize(vertices), primitive.indices = std::move(indices), primitive.material = 0;
    return primitive;
}

void expect_leaders(const scene::Primitive& primitive) {
    const gpu_scene::ProvokingVertices leading(primitive);
    const auto &indices = leading.indices(), &vertices = leading.vertices();
    ASSERT_EQ(indices.size(), primitive.indices.size());
    for (size_t i = 0; i < vertices.size(); ++i)
        if (i < primitive.vertices.size()) {
            EXPECT_EQ(vertices[i], i);
        }
    std::set<uint32_t> leaders;
    for (size_t i = 0; i < indices.size(); i += 3) {
        EXPECT_TRUE(leaders.insert(indices[i]).second) << "triangle " << i / 3 << " shares its first vertex";
        const auto at = [&](size_t k) { return vertices.at(indices[i + k]); };
        bool same = false;  // in the same turn
        for (size_t k = 0; k < 3; ++k)
            same = same || (at(0) == primitive.indices[i + k] && at(1) == primitive.indices[i + (k + 1) % 3] &&
                            at(2) == primitive.indices[i + (k + 2) % 3]);
        EXPECT_TRUE(same) << "triangle " << i / 3;
    }
}

TEST(ProvokingVertices, NoTwoTrianglesHaveTheSameFirst) {
    std::mt19937 random(1);
    for (size_t vertices : {3u, 4u, 9u, 40u})
        for (size_t triangles : {1u, 5u, 60u}) {
            std::vector<uint32_t> indices;
            for (size_t i = 0; i < 3 * triangles; ++i) indices.push_back(uint32_t(random() % vertices));
            expect_leaders(made_of(vertices, indices));
        }
}

// A strip has a vertex more than it has triangles, and one more: none is copied.
TEST(ProvokingVertices, AStripNeedsNoCopies) {
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < 100; ++i) indices.insert(indices.end(), {i, i + 1 + i % 2, i + 2 - i % 2});
    const scene::Primitive strip = made_of(102, indices);
    expect_leaders(strip);
    EXPECT_EQ(gpu_scene::ProvokingVertices(strip).vertices().size(), 102u);
}

TEST(ProvokingVertices, NothingHasNone) { EXPECT_TRUE(gpu_scene::ProvokingVertices({}).indices().empty()); }

}  // namespace
}  // namespace vesper::test::provoking_vertices_test
