// The ray caster, on shapes whose picture is known. SPDX-License-Identifier: MIT
#include "passes/gbuffer_reference.h"

#include <gtest/gtest.h>

namespace vesper::reference::gbuffer_reference_test {
namespace {

/// 64 x 64 pixels, 90 degrees each way.
Rays square() { return {{2.0 / 64, -2.0 / 64}, {-1, 1}, 0.1}; }

Triangle triangle(dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 n = glm::normalize(glm::cross(b - a, c - a));
    return {{a, b, c}, {n, n, n}, {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1)}, {dvec4(1), dvec4(1), dvec4(1)}, 0};
}

/// Two triangles that fill the 90 degree view at a depth, with uv as a picture on a wall.
Geometry wall(double depth, Surface surface = {}) {
    const double r = depth;
    Geometry g;
    g.triangles = {triangle({-r, -r, -depth}, {r, -r, -depth}, {r, r, -depth}),
                   triangle({-r, -r, -depth}, {r, r, -depth}, {-r, r, -depth})};
    g.triangles[0].uv = {dvec2(0, 1), dvec2(1, 1), dvec2(1, 0)};
    g.triangles[1].uv = {dvec2(0, 1), dvec2(1, 0), dvec2(0, 0)};
    g.surfaces = {surface};
    return g;
}

TEST(GbufferReference, FloorUnderTheEye) {
    Geometry g;
    g.planes = {{{0, -1.2, 0}, {0, 1, 0}, 0}};
    g.surfaces = {{}};
    const Rays rays = square();
    for (uint32_t y = 0; y < 64; ++y) {
        const Seen seen = cast(g, rays, {20.5, y + 0.5});
        const double slope = 1 - 2 * (y + 0.5) / 64;  // tangent above the horizon
        if (slope > 0) {
            EXPECT_EQ(seen.depth, 0) << "sky";
        } else {
            EXPECT_NEAR(seen.depth, 1.2 / -slope, 1e-9);
            EXPECT_EQ(seen.normal, dvec3(0, 1, 0));
        }
    }
}

TEST(GbufferReference, SphereHasItsSilhouetteAndNormals) {
    Geometry g;
    g.spheres = {{{0, 0, -10}, 2, 0}};
    g.surfaces = {{}};
    const Rays rays = square();
    const Seen middle = cast(g, rays, {32, 32});
    EXPECT_NEAR(middle.depth, 8, 1e-12);
    EXPECT_NEAR(glm::length(middle.normal - dvec3(0, 0, 1)), 0, 1e-12);
    const double edge = 2 / std::sqrt(10.0 * 10 - 2 * 2);  // tangent of the silhouette
    EXPECT_GT(cast(g, rays, {32 + 32 * edge * 0.999, 32}).depth, 0);
    EXPECT_EQ(cast(g, rays, {32 + 32 * edge * 1.001, 32}).depth, 0);
    for (double x : {20.0, 33.0, 38.0}) {
        const Seen s = cast(g, rays, {x, 30});
        if (s.depth == 0) continue;
        EXPECT_NEAR(glm::length(rays.at({x, 30}) * s.depth - (dvec3(0, 0, -10) + 2.0 * s.normal)), 0, 1e-12);
    }
}

TEST(GbufferReference, InsideASphereOnlyTheDoubleSidedIsSeen) {
    Geometry g;
    g.spheres = {{{0, 0, 0}, 5, 0}};
    g.surfaces = {{}};
    EXPECT_EQ(cast(g, square(), {32, 32}).depth, 0);
    g.surfaces[0].double_sided = true;
    const Seen seen = cast(g, square(), {32, 32});
    EXPECT_NEAR(seen.depth, 5, 1e-12);
    EXPECT_NEAR(seen.normal.z, 1, 1e-12) << "turned to the viewer";
}

TEST(GbufferReference, TrianglesInterpolateInSpaceNotOnTheScreen) {
    // A floor strip from z = -1 to z = -9: in the middle of the picture's span the depth is harmonic, uv with it.
    Geometry g;
    g.triangles = {triangle({-9, -1, -1}, {9, -1, -1}, {0, -1, -9})};
    g.triangles[0].uv = {dvec2(0, 0), dvec2(0, 0), dvec2(0, 1)};
    g.surfaces = {{}};
    const Rays rays = square();
    const auto m = meet(g.triangles[0], rays.at({32, 48}));  // tangent -0.5: depth 2
    ASSERT_TRUE(m);
    EXPECT_NEAR(m->depth, 2, 1e-12);
    EXPECT_NEAR(m->uv.y, 1.0 / 8, 1e-12);
    EXPECT_TRUE(m->front);
}

TEST(GbufferReference, BackFacesAreCulledOrTurned) {
    Geometry g;
    g.triangles = {triangle({-1, 1, -3}, {1, 1, -3}, {0, -1, -3})};  // clockwise from here
    g.surfaces = {{}};
    EXPECT_EQ(cast(g, square(), {32, 32}).depth, 0);
    g.surfaces[0].double_sided = true;
    EXPECT_NEAR(cast(g, square(), {32, 32}).depth, 3, 1e-12);
    EXPECT_NEAR(cast(g, square(), {32, 32}).normal.z, 1, 1e-12);
}

TEST(GbufferReference, TheNearestCountsAndNothingBeforeTheNearPlane) {
    Geometry g = wall(10);
    g.spheres = {{{0, 0, -5}, 1, 0}};
    EXPECT_NEAR(cast(g, square(), {32, 32}).depth, 4, 1e-12);
    EXPECT_NEAR(cast(g, square(), {4, 4}).depth, 10, 1e-12);
    Rays rays = square();
    rays.near = 7;
    EXPECT_NEAR(cast(g, rays, {32, 32}).depth, 10, 1e-12);
}

Texture checker(uint32_t width, uint32_t height) {
    Texture t{width, height, {}};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            t.texels.push_back((x + y) % 2 ? dvec4(1, 0.5, 0.25, 1) : dvec4(0, 0, 0, 1));
    return t;
}

TEST(GbufferReference, TexturesWrap) {
    Texture t{4, 1, {dvec4(0), dvec4(1), dvec4(2), dvec4(3)}};
    EXPECT_EQ(t.nearest({1.3, 0.5}).x, 1);
    EXPECT_EQ(t.nearest({-0.1, 0.5}).x, 3);
    EXPECT_EQ(t.bilinear({0, 0.5}).x, 1.5) << "between the last and the first";
    t.wrap_u = Wrapping::Mirror;
    EXPECT_EQ(t.nearest({1.1, 0.5}).x, 3);
    EXPECT_EQ(t.nearest({-0.3, 0.5}).x, 1);
    EXPECT_EQ(t.bilinear({0, 0.5}).x, 0);
    t.wrap_u = Wrapping::Clamp;
    EXPECT_EQ(t.nearest({7, 0.5}).x, 3);
}

TEST(GbufferReference, TexturesAreFilteredAsAsked) {
    Surface s;
    s.base_texture = checker(16, 16);  // a texel per 4 x 4 pixels of the wall
    const Geometry g = wall(3, s);
    EXPECT_EQ(cast(g, square(), {6, 2}, Filter::Nearest).base, dvec3(1, 0.5, 0.25)) << "second texel of the first row";
    EXPECT_EQ(cast(g, square(), {2, 2}, Filter::Nearest).base, dvec3(0));
    EXPECT_NEAR(cast(g, square(), {4, 2}, Filter::Bilinear).base.x, 0.5, 1e-9);
    Surface fine;
    fine.base_texture = checker(256, 256);  // 4 x 4 texels per pixel: half of each
    EXPECT_NEAR(cast(wall(3, fine), square(), {31.5, 17.5}, Filter::Area).base.y, 0.25, 1e-9);
}

TEST(GbufferReference, MaterialsMultiplyTheirFactors) {
    Surface s;
    s.base = {0.5, 1, 1, 1}, s.metallic = 0.5, s.roughness = 0.8, s.emission = {100, 200, 300};
    s.base_texture = Texture{1, 1, {dvec4(0.4, 0.2, 0.1, 1)}};
    s.metallic_roughness_texture = Texture{1, 1, {dvec4(0.9, 0.5, 0.25, 1)}};
    s.emission_texture = Texture{1, 1, {dvec4(1, 0.5, 0, 1)}};
    Geometry g = wall(2, s);
    for (Triangle& t : g.triangles) t.colour = {dvec4(1, 0.5, 1, 1), dvec4(1, 0.5, 1, 1), dvec4(1, 0.5, 1, 1)};
    const Seen seen = cast(g, square(), {10, 50});
    EXPECT_NEAR(glm::length(seen.base - dvec3(0.2, 0.1, 0.1)), 0, 1e-12);
    EXPECT_NEAR(seen.metallic, 0.125, 1e-12);
    EXPECT_NEAR(seen.roughness, 0.4, 1e-12);
    EXPECT_NEAR(glm::length(seen.emission - dvec3(100, 100, 0)), 0, 1e-12);
}

TEST(GbufferReference, HolesShowWhatIsBehind) {
    Surface leaf;
    leaf.alpha_cutoff = 0.5;
    leaf.base_texture = Texture{2, 1, {dvec4(1, 1, 1, 0.4), dvec4(1, 1, 1, 0.6)}};
    Geometry g = wall(2, leaf);
    const Geometry behind = wall(9);
    for (Triangle t : behind.triangles) t.surface = 1, g.triangles.push_back(t);
    g.surfaces.push_back({});
    EXPECT_NEAR(cast(g, square(), {10, 30}, Filter::Nearest).depth, 9, 1e-12);
    EXPECT_NEAR(cast(g, square(), {50, 30}, Filter::Nearest).depth, 2, 1e-12);
}

TEST(GbufferReference, EdgesAreInDoubtAndInsidesAreNot) {
    Geometry g;
    g.triangles = {triangle({-1, -1, -2}, {1, -1, -2}, {0, 1, -2})};
    g.surfaces = {{}};
    const Rays rays = square();
    EXPECT_TRUE(certain(g, rays, {32.5, 32.5}));
    EXPECT_TRUE(certain(g, rays, {2.5, 2.5}));
    EXPECT_FALSE(certain(g, rays, {32.25, 48.0})) << "on the lower edge";
}

}  // namespace
}  // namespace vesper::reference::gbuffer_reference_test
