// Flat pieces of meshes. SPDX-License-Identifier: MIT
#include "gpu_scene/facets.h"

#include <random>

#include <gtest/gtest.h>

namespace vesper::test::facets_test {
namespace {

using gpu_scene::Facet;

scene::Primitive made_of(const std::vector<glm::vec3>& places, std::vector<uint32_t> indices) {
    scene::Primitive primitive;
    primitive.indices = std::move(indices), primitive.material = 0;
    for (const glm::vec3& place : places) primitive.vertices.emplace_back().position = place;
    return primitive;
}

glm::vec3 area_of(const scene::Primitive& primitive, const Facet& facet) {
    glm::vec3 twice(0);
    const auto at = [&](size_t k) { return primitive.vertices[facet.corners[k]].position; };
    for (size_t k = 2; k < facet.count; ++k) twice += glm::cross(at(k - 1) - at(0), at(k) - at(0));
    return twice / 2.0f;
}

TEST(Facets, ARectangleIsOneOfBothItsTriangles) {
    const std::vector<glm::vec3> places{{0, 0, 1}, {3, 0, 1}, {3, 2, 1}, {0, 2, 1}};
    // Whichever corner is first, and whether or not they share vertices.
    const auto apart = [&] {
        std::vector<glm::vec3> twice = places;
        twice.insert(twice.end(), places.begin(), places.end());
        return twice;
    }();
    for (const auto& [corners, indices] : {std::pair(places, std::vector<uint32_t>{0, 1, 2, 0, 2, 3}),
                                           {places, {1, 2, 0, 3, 0, 2}},
                                           {places, {2, 0, 1, 2, 3, 0}},
                                           {apart, {0, 1, 2, 4, 6, 7}}}) {
        const scene::Primitive rectangle = made_of(corners, indices);
        const std::vector<Facet> found = gpu_scene::facets(rectangle, {});
        ASSERT_EQ(found.size(), 2u);
        for (size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(found[i].count, 4u);
            EXPECT_EQ(found[i].corners[0], indices[3 * i]) << "a facet begins where its triangle does";
            EXPECT_EQ(area_of(rectangle, found[i]), glm::vec3(0, 0, 6));
        }
    }
}

TEST(Facets, TrianglesThatMakeNoneStayAlone) {
    struct Case {
        const char* what;
        std::vector<glm::vec3> places;
        std::vector<uint32_t> indices;
    };
    for (const Case& c :
         {Case{"folded by 1 degree", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.0175f}}, {0, 1, 2, 0, 2, 3}},
          {"not convex", {{0, 0, 0}, {1, 0, 0}, {0.2f, 0.2f, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}},
          {"back to back", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 1}},
          {"apart", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {0, 1, 2, 3, 4, 5}},
          {"of no area", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {0, 1, 2, 0, 2, 3}}}) {
        const scene::Primitive two = made_of(c.places, c.indices);
        for (const Facet& facet : gpu_scene::facets(two, {})) EXPECT_EQ(facet.count, 3u) << c.what;
    }
}

// Of a strip of rectangles, each triangle's longest edge is its diagonal.
TEST(Facets, AWallOfRectanglesIsFacetsAlongItsDiagonals) {
    std::vector<glm::vec3> places;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < 20; ++i) {
        places.push_back({float(i), 0, 0}), places.push_back({float(i), 3, 0});
        if (i > 0) indices.insert(indices.end(), {2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 2, 2 * i + 1, 2 * i - 1});
    }
    const scene::Primitive wall = made_of(places, indices);
    for (const Facet& facet : gpu_scene::facets(wall, {})) {
        EXPECT_EQ(facet.count, 4u);
        EXPECT_EQ(area_of(wall, facet), glm::vec3(0, 0, 3));
    }
}

// The two triangles of a rectangle, with vertices of their own; the second one's of this colour and these coordinates.
scene::Primitive two_of(uint16_t red, const std::vector<glm::vec2>& uv) {
    scene::Primitive two =
        made_of({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {0, 1, 2, 3, 4, 5});
    const std::vector<glm::vec2> plain{{0, 0}, {1, 0}, {1, 1}};
    for (size_t i = 0; i < 3; ++i) {
        two.vertices[i].uv = plain[i];
        two.vertices[3 + i].uv = uv[i], two.vertices[3 + i].colour[0] = red;
    }
    return two;
}

TEST(Facets, BordersOfColourPartRegions) {
    scene::Material plain, textured, picture, masked;
    textured.base_colour_texture.image = 0, picture.emission_picture.image = 0;
    masked = textured, masked.alpha = scene::Material::Alpha::Mask;
    const std::vector<glm::vec2> goes_on{{0, 0}, {1, 1}, {0, 1}}, elsewhere{{0.5f, 0}, {0.6f, 1}, {0.5f, 1}},
        bent{{0, 0}, {1, 1}, {0, 0.9f}};
    const auto is_one = [](const scene::Primitive& primitive, const scene::Material& material) {
        const std::vector<Facet> found = gpu_scene::facets(primitive, material);
        return std::pair(found[0].region == found[1].region, found[0].count == 4 && found[1].count == 4);
    };
    using Is = std::pair<bool, bool>;  // one region; one quadrilateral
    EXPECT_EQ(is_one(two_of(65535, goes_on), plain), Is(true, true));
    EXPECT_EQ(is_one(two_of(65000, goes_on), plain), Is(false, false)) << "another colour";
    EXPECT_EQ(is_one(two_of(65500, goes_on), plain), Is(true, true)) << "less than any screen shows";
    EXPECT_EQ(is_one(two_of(65535, elsewhere), plain), Is(true, true)) << "no texture is there";
    for (const scene::Material& material : {textured, picture, masked}) {
        EXPECT_EQ(is_one(two_of(65535, goes_on), material), Is(true, true));
        EXPECT_EQ(is_one(two_of(65535, elsewhere), material), Is(false, false));
        EXPECT_EQ(is_one(two_of(65000, goes_on), material), Is(false, false));
    }
    EXPECT_EQ(is_one(two_of(65535, bent), textured), Is(true, true));
    EXPECT_EQ(is_one(two_of(65535, bent), masked), Is(true, false)) << "holes would be elsewhere";
}

// Without a texture what has one colour is one, though it shares no corner.
TEST(Facets, TrianglesApartAreOneRegionByTheirColour) {
    scene::Primitive three =
        made_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 0, 0}, {8, 0, 0}, {9, 1, 0}},
                {0, 1, 2, 3, 4, 5, 6, 7, 8});
    for (size_t i = 3; i < 6; ++i) three.vertices[i].colour = {1, 2, 3, 65535};
    const std::vector<Facet> found = gpu_scene::facets(three, {});
    EXPECT_EQ(found[0].region, found[2].region);
    EXPECT_NE(found[0].region, found[1].region);
    scene::Material textured;
    textured.base_colour_texture.image = 0;
    const std::vector<Facet> apart = gpu_scene::facets(three, textured);
    EXPECT_NE(apart[0].region, apart[2].region);
}

// Places that are none, and edges of very many triangles, end.
TEST(Facets, BrokenTrianglesMakeNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(
        gpu_scene::facets(made_of({{0, 0, nan}, {1, 0, 0}, {1, inf, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}), {}).size(),
        2u);
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < 20000; ++i) indices.insert(indices.end(), {i % 2, 1 - i % 2, 2});
    EXPECT_EQ(gpu_scene::facets(made_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, indices), {}).size(), 20000u);
    EXPECT_TRUE(gpu_scene::facets({}, {}).empty());
}

}  // namespace
}  // namespace vesper::test::facets_test
