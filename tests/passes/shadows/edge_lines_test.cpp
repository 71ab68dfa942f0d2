// Edges of shadows where texels are wider than pixels, and on surfaces whose normals are interpolated over few
// triangles. SPDX-License-Identifier: MIT
#include "passes/shadows/edge_lines_reference.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "passes/shadows/lit_wall.h"
#include "support/noise.h"
#include "support/occluders.h"

namespace vesper::test::edge_lines_test {
namespace {

// Spots of some texels: each pixel of blocks that are planes has the share of the reference.
TEST(EdgeLines, WideTexelsHaveTheLinesOfTheReference) {
    PassRig rig;
    for (const auto& [zoom, flat] : {std::pair(0.9, false), {0.8, true}}) {
        SCOPED_TRACE(zoom);
        Noise noise(7);
        std::vector<double> waves;
        for (int k = 0; k < 12; ++k) waves.push_back(noise.fine());
        LitWall wall(
            [&](uint32_t x, uint32_t y) {
                double sum = 0;
                for (size_t k = 0; k < waves.size(); k += 3)
                    sum += std::sin(0.9 * waves[k] * x + 0.9 * waves[k + 1] * y + 6 * waves[k + 2]);
                return sum > 0;
            },
            {.zoom = zoom, .flat = flat});
        const std::vector<glm::vec4> whole = wall.render(rig, false), got = wall.render(rig, true);
        const uint32_t width = wall.view.extent.width, height = wall.view.extent.height;
        size_t compared = 0, between = 0, agreed = 0, wrong = 0;
        for (uint32_t block = 0; block < (width / 8) * (height / 8); ++block) {
            const glm::uvec2 corner(block % (width / 8) * 8, block / (width / 8) * 8);
            const auto seen = [&](uint32_t k) {
                return wall.light(got, whole, size_t(corner.y + k / 8) * width + corner.x + k % 8);
            };
            if (!wall.reached(corner) || !wall.reached(corner + 7u) || !wall.reached(corner + glm::uvec2(7, 0)) ||
                !wall.reached(corner + glm::uvec2(0, 7)))
                continue;
            bool same = true;
            for (uint32_t k = 1; k < 64; ++k) same = same && seen(k) == seen(0);
            const glm::ivec2 first = glm::ivec2(wall.texel(glm::dvec2(corner) + glm::dvec2(3, 4))) - 8;
            reference::TexelWindow window{};
            for (int j = 0; j < 16; ++j)
                for (int i = 0; i < 16; ++i) window[size_t(j)][size_t(i)] = wall.sees(first.x + i, first.y + j);
            for (uint32_t k = 0; k < 64; ++k) {
                const glm::dvec2 pixel = glm::dvec2(corner) + glm::dvec2(k % 8, k / 8), column(pixel.x, corner.y + 4);
                const glm::dvec2 at = wall.texel(pixel) - 0.5 - glm::dvec2(first), half_right(0.5, 0),
                                 half_down(0, 0.5);
                const glm::dvec2 right = wall.texel(column + half_right) - wall.texel(column - half_right),
                                 down = wall.texel(column + half_down) - wall.texel(column - half_down);
                ASSERT_LT(std::max(glm::length(right), glm::length(down)), 0.5) << "texels are wide";
                const auto near = [](double v) { return std::abs(v - std::round(v)) < 2e-3; };
                if (near(at.x) || near(at.y) || near(at.x + 0.5) || near(at.y + 0.5)) continue;
                const double want = reference::line_share(window, at, right, down);
                ++compared;
                between += want > 0.03 && want < 0.97 ? 1 : 0;
                const bool off = std::abs(seen(k) - want) > 1.0 / 30 + 0.03;
                agreed += off && same ? 1 : 0, wrong += off && !same ? 1 : 0;
            }
        }
        EXPECT_LT(wrong, compared / 2000) << "lines that bend within a pixel, at borders of quadrants";
        EXPECT_LT(agreed, compared / 100) << "blocks whose probes agree and other pixels do not";
        EXPECT_GT(compared, 20'000u);
        EXPECT_GT(between, 500u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A straight edge stays in a strip half as wide as stairs of its texels would take.
TEST(EdgeLines, StraightEdgesHaveNoStairs) {
    PassRig rig;
    for (const double angle : {0.18, 0.3, 0.5, 1.3, 1.4}) {
        SCOPED_TRACE(angle);
        const glm::dvec2 normal(-std::sin(angle), std::cos(angle));
        const LitWall wall([&](uint32_t x, uint32_t y) { return glm::dot(normal, glm::dvec2(x, y) + 0.5 - 31.3) > 0; },
                           {.fov = 0.1f});
        const std::vector<glm::vec4> whole = wall.render(rig, false), got = wall.render(rig, true);
        size_t dark = 0, lit = 0;
        double farthest_lit = -1e3, nearest_dark = 1e3;  // beyond the edge, texels
        for (size_t i = 0; i < got.size(); ++i) {
            const double off = glm::dot(normal, wall.texel(wall.s.pixel(i)) - 31.3), seen = wall.light(got, whole, i);
            (seen == 0 ? dark : lit) += 1;
            if (seen > 0.5) farthest_lit = std::max(farthest_lit, off);
            if (seen < 0.5) nearest_dark = std::min(nearest_dark, off);
        }
        EXPECT_LT(farthest_lit - nearest_dark, 0.5);
        EXPECT_GT(dark, 4000u);
        EXPECT_GT(lit, 4000u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A pixel that is not finite changes no other.
TEST(EdgeLines, NanStaysWhereItIs) {
    PassRig rig;
    LitWall wall([](uint32_t x, uint32_t y) { return 3 * x > y + 60; });
    const std::vector<glm::vec4> whole = wall.render(rig, true);
    for (size_t i = 5; i < wall.s.surface.size(); i += 31)
        wall.s.surface[i].z = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec4> got = wall.render(rig, true);
    size_t others = 0;
    for (size_t i = 0; i < got.size(); ++i)
        if (i % 31 != 5) others += got[i] == whole[i] ? 0 : 1;
    EXPECT_LT(others, got.size() / 100) << "in blocks whose probes are others";
    EXPECT_EQ(rig.complaints(), "");
}

constexpr int kSides = 8;
constexpr double kRadius = 0.6, kHeight = 2, kSideAngle = 2 * kPi / kSides;  // of a column on the origin, m; rad

/// Its sides are planes, its normals those of a cylinder.
void add_column(scene::Scene& scene) {
    scene::Primitive& p = scene.meshes.emplace_back().primitives.emplace_back();
    for (int k = 0; k <= kSides; ++k)
        for (const double y : {0.0, kHeight}) {
            scene::Vertex& v = p.vertices.emplace_back();
            v.normal = glm::vec3(std::cos(k * kSideAngle), 0, std::sin(k * kSideAngle));
            v.position = glm::vec3(kRadius * glm::dvec3(v.normal) + glm::dvec3(0, y, 0));
        }
    for (uint32_t k = 0; k < 2 * kSides; k += 2)
        for (const uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u}) p.indices.push_back(k + i);
    scene.nodes.emplace_back().mesh = uint32_t(scene.meshes.size() - 1);
}

// A wall whose normals turn away from it hides none of itself, at texels of many pixels.
TEST(BentSurfaces, NormalsHideNothingOfAPlane) {
    PassRig rig;
    for (const auto& [tilt, flat] : {std::pair(0.3, false), {-1.1, false}, {1.1, true}}) {
        SCOPED_TRACE(tilt);
        LitWall wall([](uint32_t, uint32_t) { return false; }, {.flat = flat});
        for (glm::vec4& surface : wall.s.surface) {
            const glm::vec2 normal(reference::octahedral_encode({std::sin(tilt), 0, std::cos(tilt)}));
            surface.x = normal.x, surface.y = normal.y;
        }
        wall.s.slope.assign(wall.s.surface.size(), 0);  // halves: its depth is the same everywhere
        const std::vector<glm::vec4> whole = wall.render(rig, false), got = wall.render(rig, true);
        size_t lit = 0;
        for (size_t i = 0; i < got.size(); ++i) {
            EXPECT_EQ(got[i], whole[i]) << wall.s.pixel(i).x << " " << wall.s.pixel(i).y;
            lit += whole[i].x > 0 ? 1 : 0;
        }
        EXPECT_GT(lit, got.size() / 2);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// The wall hides none of itself: across hemispheres and quadrants of maps, and where light grazes.
TEST(EdgeLines, APlaneHidesNothingOfItself) {
    PassRig rig;
    for (const double angle : {0.4, 1.2, 1.57, 1.9, 2.6})
        for (const double away : {3.0, 0.3}) {
            SCOPED_TRACE(std::to_string(angle) + " rad, " + std::to_string(away) + " m");
            const glm::dquat turn = glm::angleAxis(angle, glm::normalize(glm::dvec3(1, 0.3, 0.1)));
            const LitWall wall([](uint32_t, uint32_t) { return false; },
                               {.zoom = 1, .flat = false, .turn = turn, .away = away, .hemispheres = 2});
            const std::vector<glm::vec4> whole = wall.render(rig, false), got = wall.render(rig, true);
            size_t other = 0;
            for (size_t i = 0; i < got.size(); ++i) other += got[i] == whole[i] ? 0 : 1;
            EXPECT_EQ(other, 0u);
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Leaves of trees: their normals are those of the crown, and lamps behind them light them. Its own plane hides none of
// it.
TEST(BentSurfaces, TrianglesThatFaceAwayAreLitAsTheirNormalsSay) {
    PassRig rig;
    LitWall wall([](uint32_t, uint32_t) { return false; });
    // Planes whose normals are (-20, 0, 1 - 20 x) at the view tangent x: left of the middle they face away from the
    // lamp.
    const float tilt = 20 * wall.view.ray_scale().x * shared::kSlopeScale;
    wall.s.slope.assign(wall.s.surface.size(), glm::packHalf2x16({tilt, 0}));
    const std::vector<glm::vec4> whole = wall.render(rig, false), got = wall.render(rig, true);
    for (size_t i = 0; i < got.size(); ++i)
        if (wall.s.pixel(i).x < wall.view.extent.width / 2) {
            EXPECT_EQ(got[i], whole[i]) << i;
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Sides that face the lamp are lit wherever their normals face it, without dark rows.
TEST(BentSurfaces, SidesOfAColumnThatFaceTheLampAreLit) {
    PassRig rig;
    for (const double turn : {-0.5, -0.25, 0.15, 2.2, 2.45, 2.7}) {
        SCOPED_TRACE(turn);
        OccluderScene s;
        add_column(s.scene());
        scene::Lamp lamp;
        lamp.kind = scene::Lamp::Kind::Point, lamp.intensity = 1e5f;
        // Texels of its map are 8 cm there, and pixels 1 cm.
        const glm::dvec3 place(60 * std::cos(turn), 1.3, 60 * std::sin(turn));
        s.lamp(lamp, place);
        Lit all(rig, s.scene());
        const gpu_scene::View view = gpu_scene::View::symmetric(
            {301, 203}, 0.55f, glm::lookAt(glm::vec3(2, 1.5f, 4), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0)));
        const Lit::Picture p = all.render(view);
        const glm::dmat4 to_world = glm::inverse(glm::dmat4(view.world_to_view));
        size_t lit = 0, wrong = 0;
        for (size_t i = 0; i < p.pixels.size(); ++i) {
            if (!(p.surfaces[i].z > 0)) continue;
            const glm::dvec3 at(to_world * glm::dvec4(p.place(i, view.extent.width), 1)), to = place - at;
            const double angle = std::atan2(at.z, at.x) / kSideAngle, part = angle - std::floor(angle);
            if (std::min(part, 1 - part) < 0.04 || std::min(at.y, kHeight - at.y) < 0.05) continue;
            const double middle = (std::floor(angle) + 0.5) * kSideAngle;
            const double side = glm::dot(glm::dvec3(std::cos(middle), 0, std::sin(middle)), to) / glm::length(to);
            const glm::dvec3 normal = glm::dmat3(to_world) * reference::octahedral_decode(glm::dvec2(p.surfaces[i]));
            const double cosine = glm::dot(normal, to) / glm::length(to);
            if (side < 0.01 || cosine < 0.01) continue;
            const double seen = double(p.pixels[i].x) / (1e5 * cosine / glm::dot(to, to) / kPi);
            ++lit;
            wrong += std::abs(seen - 1) > 0.01 ? 1 : 0;
        }
        EXPECT_GT(lit, 2000u);
        EXPECT_EQ(wrong, 0u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::edge_lines_test
