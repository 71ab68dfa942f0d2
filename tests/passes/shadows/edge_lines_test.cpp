// Edges of shadows where texels are wider than pixels. SPDX-License-Identifier: MIT
#include "passes/shadows/edge_lines_reference.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "passes/shadows/draw_shadow_maps_reference.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::edge_lines_test {
namespace {

constexpr uint32_t kSide = 64;
constexpr double kAway = 8, kLampAway = 3;  // of a wall from the eye, and of a lamp from the wall, m

/// A wall across the view, a lamp before it whose map has walls of its own where `hides` a direction.
struct Wall {
    gpu_scene::View view;
    Surfaces s;
    gpu_scene::LampList list;
    render::MapFrame turned =
        render::map_frame(glm::mat4_cast(glm::angleAxis(0.5, glm::normalize(glm::dvec3(0.1, 0.2, 1)))));
    reference::HemisphereMap map{kSide, {}};
    double zoom;
    bool flat;

    template <class Hides>
    Wall(const Hides& hides, double map_zoom, bool map_flat, float fov = 0.4f)
        : view(gpu_scene::View::symmetric({203, 121}, fov, glm::mat4(1))),
          s{view.extent, {}, {}, {}},
          zoom(map_zoom),
          flat(map_flat) {
        for (uint32_t i = 0; i < view.extent.width * view.extent.height; ++i) {
            s.reflectance.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
            s.surface.emplace_back(glm::vec2(reference::octahedral_encode({0, 0, 1})), float(kAway), 1.0f);
            s.emission.emplace_back(0);
        }
        shared::Lamp lamp{};
        lamp.position = {0.3f, 0.2f, float(kLampAway - kAway)}, lamp.intensity = 1000, lamp.axis = {0, 0, -1};
        lamp.lobe_b = 1, lamp.colour = glm::vec3(1);
        list.lamps = {lamp}, list.indices = {0}, list.counts = {1, 0, 0, 0};
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) map.norms.push_back(hides(x, y) ? 1.0 : 1e4);
    }
    double light(const std::vector<glm::vec4>& pixels, const std::vector<glm::vec4>& whole, size_t i) const {
        return double(pixels[i].x / whole[i].x);
    }
    std::vector<glm::vec4> render(PassRig& rig, bool shadows) const {
        std::vector<uint16_t> texels;
        for (const double norm : map.norms) texels.push_back(glm::packHalf1x16(float(norm)));
        const std::vector maps{render::shadow_map(
            {.side = kSide, .hemispheres = 1, .zoom = float(zoom), .flat = flat, .range = 1, .radius = 0, .first = 0},
            turned, view)};
        graph::FrameGraph graph;
        render::FrameShadowMaps seen;
        if (shadows)
            seen = {graph.upload("maps", maps, VK_FORMAT_R32G32B32A32_SFLOAT),
                    graph.upload("distances", texels, VK_FORMAT_R16_SFLOAT)};
        const LitBlocks lit = test::light(rig.frame(graph, view), upload(graph, s), list, no_tables(graph), {},
                                          {.merge_error = 0, .maps = seen, .shadow_error = 0, .probe_error = 0});
        const graph::Resource picture = keep<glm::vec4>(graph, lit.scene);
        rig.run(graph);
        return rig.got<glm::vec4>(picture);
    }
    glm::dvec3 point(glm::dvec2 pixel) const {
        const glm::dvec2 ray = glm::dvec2(view.ray_scale()) * (pixel + 0.5) + glm::dvec2(view.ray_offset());
        return kAway * glm::dvec3(ray, -1);
    }
    /// Whether the map reaches it; beyond, all is lit.
    bool reached(glm::dvec2 pixel) const {
        const glm::dvec2 at = texel(pixel);
        return std::min(at.x, at.y) > 0.01 && std::max(at.x, at.y) < kSide - 0.01;
    }
    /// Its place in the map, texels.
    glm::dvec2 texel(glm::dvec2 pixel) const {
        const glm::dvec3 way = turned.rotation * (point(pixel) - glm::dvec3(list.lamps[0].position));
        return reference::map_texel(way, kSide, zoom, flat);
    }
};

// Spots of some texels: each pixel of blocks that are planes has the share of the reference.
TEST(EdgeLines, WideTexelsHaveTheLinesOfTheReference) {
    PassRig rig;
    for (const auto& [zoom, flat] : {std::pair(0.9, false), {0.8, true}}) {
        SCOPED_TRACE(zoom);
        Noise noise(7);
        std::vector<double> waves;
        for (int k = 0; k < 12; ++k) waves.push_back(noise.fine());
        Wall wall(
            [&](uint32_t x, uint32_t y) {
                double sum = 0;
                for (size_t k = 0; k < waves.size(); k += 3)
                    sum += std::sin(0.9 * waves[k] * x + 0.9 * waves[k + 1] * y + 6 * waves[k + 2]);
                return sum > 0;
            },
            zoom, flat);
        const std::vector<glm::vec4> whole = wall.render(rig, false), got = wall.render(rig, true);
        const auto [width, height] = wall.view.extent;
        size_t compared = 0, between = 0, agreed = 0;
        for (uint32_t block = 0; block < (width / 8) * (height / 8); ++block) {
            const glm::uvec2 corner(block % (width / 8) * 8, block / (width / 8) * 8);
            const auto seen = [&](uint32_t k) {
                return wall.light(got, whole, size_t(corner.y + k / 8) * width + corner.x + k % 8);
            };
            bool same = true;
            for (uint32_t k = 1; k < 64; ++k) same = same && seen(k) == seen(0);
            const glm::ivec2 first = glm::ivec2(wall.texel(glm::dvec2(corner) + glm::dvec2(3, 4))) - 8;
            reference::TexelWindow window{};
            for (int j = 0; j < 16; ++j)
                for (int i = 0; i < 16; ++i) window[size_t(j)][size_t(i)] = wall.map.at(first.x + i, first.y + j) > 100;
            for (uint32_t k = 0; k < 64; ++k) {
                const glm::dvec2 pixel = glm::dvec2(corner) + glm::dvec2(k % 8, k / 8), column(pixel.x, corner.y + 4);
                const glm::dvec2 at = wall.texel(pixel) - 0.5 - glm::dvec2(first), half_right(0.5, 0),
                                 half_down(0, 0.5);
                const glm::dvec2 right = wall.texel(column + half_right) - wall.texel(column - half_right),
                                 down = wall.texel(column + half_down) - wall.texel(column - half_down);
                ASSERT_LT(std::max(glm::length(right), glm::length(down)), 0.5) << "texels are wide";
                const auto near = [](double v) { return std::abs(v - std::round(v)) < 2e-3; };
                if (!wall.reached(pixel) || near(at.x) || near(at.y) || near(at.x + 0.5) || near(at.y + 0.5)) continue;
                const double want = reference::line_share(window, at, right, down);
                ++compared;
                between += want > 0.03 && want < 0.97 ? 1 : 0;
                const bool off = std::abs(seen(k) - want) > 1.0 / 30 + 0.03;
                if (off && same)
                    ++agreed;
                else
                    EXPECT_FALSE(off) << pixel.x << " " << pixel.y << ": " << seen(k) << ", want " << want;
            }
        }
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
        const Wall wall([&](uint32_t x, uint32_t y) { return glm::dot(normal, glm::dvec2(x, y) + 0.5 - 31.3) > 0; },
                        0.8, true, 0.1f);
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
    Wall wall([](uint32_t x, uint32_t y) { return 3 * x > y + 60; }, 0.8, true);
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

}  // namespace
}  // namespace vesper::test::edge_lines_test
