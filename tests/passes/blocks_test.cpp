// Blocks of the image on the device: their classes, and the lamps that are added up over them.
// SPDX-License-Identifier: MIT
#include "passes/blocks_reference.h"

#include <algorithm>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "render/passes/blocks.h"
#include "support/lamps.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::blocks_test {
namespace {

constexpr float kTolerance = 1e-3f;
constexpr float kAll = 1e-9f;  // lx: a threshold that leaves no lamp out

/// A road of some kind 1.2 m under the eye between walls at 8 m, sky above 20 m; and, in squares here and there, what
/// makes other classes.
Surfaces canyon(VkExtent2D extent, float road_kind = 0, bool mixed = true, bool sheets = false) {
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.7f, glm::mat4(1));
    Surfaces s{extent, {}, {}, {}};
    Noise noise(extent.width);
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const glm::uvec2 pixel = s.pixel(i);
        const glm::dvec2 ray = glm::dvec2(view.ray_scale()) * (glm::dvec2(pixel) + 0.5) + glm::dvec2(view.ray_offset());
        const double road = ray.y < 0 ? 1.2 / -ray.y : 1e6, wall = 8 / std::max(std::abs(ray.x), 1e-6),
                     depth = std::min(road, wall);
        const bool on_road = road<wall, sky = depth * ray.y> 20 || depth > 1000;
        glm::dvec3 normal = on_road ? glm::dvec3(0, 1, 0) : glm::dvec3(ray.x < 0 ? 1 : -1, 0, 0);
        float kind = on_road ? road_kind : 0, roughness = kind < 0 ? -0.6f : 1;
        const uint32_t square = (pixel.x / 24 + 3 * (pixel.y / 24)) % 11;
        if (mixed && square == 1) roughness = kind < 0 ? roughness : 0.4f;                    // glossy
        if (mixed && square == 4) kind = kind < 0 ? kind : noise.fine();                      // metal
        if (mixed && square == 6) normal = glm::normalize(normal + 0.3 * noise.facing(0.1));  // bumps
        if (mixed && sheets && square == 8) kind = shared::kRetroCode, roughness = 1;
        s.reflectance.emplace_back(noise.fine(), noise.fine(), noise.fine(), kind);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(normal)), sky ? 0.0f : float(depth), roughness);
        s.emission.emplace_back(0);
    }
    return s;
}

reference::Block block_of(const Surfaces& s, uint32_t x, uint32_t y) {
    reference::Block block{{x * shared::kBlockSize, y * shared::kBlockSize}, {}, {}};
    for (uint32_t j = block.corner.y; j < std::min(block.corner.y + shared::kBlockSize, s.extent.height); ++j)
        for (uint32_t i = block.corner.x; i < std::min(block.corner.x + shared::kBlockSize, s.extent.width); ++i) {
            const reference::SurfaceTexel t = s.texel(size_t(j) * s.extent.width + i);
            if (t.surface.z > 0) block.pixels.emplace_back(i, j), block.texels.push_back(t);
        }
    return block;
}

struct Merged {
    render::Blocks blocks;
    shared::ClusterPush cluster;
    std::vector<uint32_t> counts, entries, class_counts, class_blocks;
    std::vector<glm::vec4> sums;

    uint32_t listed(uint32_t block) const { return counts[2 * block] + counts[2 * block + 1]; }
    std::multiset<uint32_t> lamps(uint32_t block) const {
        std::multiset<uint32_t> all;
        const size_t first = size_t(block) * blocks.capacity;
        for (uint32_t i = 0; i < counts[2 * block]; ++i)
            all.insert(entries[first + i] & ((1u << shared::kFirstSliceShift) - 1));
        for (uint32_t i = 0; i < counts[2 * block + 1]; ++i)
            all.insert(entries[first + blocks.capacity - 1 - i] & ((1u << shared::kFirstSliceShift) - 1));
        return all;
    }
    glm::dvec3 sum(uint32_t block, int i, int j) const {
        glm::dvec3 value;
        for (int c = 0; c < 3; ++c) {
            const size_t at = size_t(3 * (3 * j + i) + c);
            value[c] = double(sums[size_t(block) * shared::kMergedTexels + at / 4][int(at % 4)]);
        }
        return value;
    }
};

Merged merge(PassRig& rig, const Surfaces& s, const gpu_scene::LampList& list, float tolerance = kTolerance,
             float far = 0) {
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, gpu_scene::View::symmetric(s.extent, 0.7f, glm::mat4(1)));
    const render::GBuffer g = upload(graph, s);
    const render::Clusters c = render::add_clusters(frame, g.surface, list, no_tables(graph), {.far = far});
    Merged got;
    got.blocks = render::add_merging(frame, g, c, render::add_blocks(frame, g, c), tolerance);
    got.cluster = c.push;
    const render::Blocks& b = got.blocks;
    const graph::Resource counts = keep<uint32_t>(graph, b.counts), entries = keep<uint32_t>(graph, b.entries),
                          sums = keep<glm::vec4>(graph, b.sums), classes = keep<uint32_t>(graph, b.class_counts),
                          members = keep<uint32_t>(graph, b.class_blocks);
    rig.run(graph);
    got.counts = rig.got<uint32_t>(counts), got.entries = rig.got<uint32_t>(entries),
    got.sums = rig.got<glm::vec4>(sums);
    got.class_counts = rig.got<uint32_t>(classes), got.class_blocks = rig.got<uint32_t>(members);
    return got;
}

// A lamp is on the list, or in the sums, or gives nothing; and it is in the sums exactly where it is smooth.
TEST(Blocks, EveryLampIsListedOrAddedUp) {
    PassRig rig;
    using Case = std::pair<VkExtent2D, float>;  // px; m, where geometry ends: near, and slices are thin
    for (const auto& [extent, far] :
         {Case{{1, 1}, 0.0f}, {{7, 5}, 0.0f}, {{33, 9}, 0.0f}, {{203, 131}, 0.0f}, {{203, 131}, 60.0f}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height) + ", far " +
                     std::to_string(far));
        const Surfaces s = canyon(extent);
        const gpu_scene::LampList list = street_lamps({20, 20, 0}, 300, extent.width);
        const Merged got = merge(rig, s, list, kTolerance, far);
        uint32_t planes = 0, taken = 0, sliced = 0;
        for (uint32_t b = 0; b < got.blocks.count; ++b) {
            const reference::Block block = block_of(s, b % got.blocks.columns, b / got.blocks.columns);
            const auto plane = reference::plane_of(block, got.cluster.grid);
            const std::multiset<uint32_t> listed = got.lamps(b);
            std::set<uint32_t> slices;
            for (const reference::SurfaceTexel& t : block.texels)
                slices.insert(reference::slice_of(got.cluster.grid, t.surface.z));
            const bool many = slices.size() > 3;  // a lamp is listed several times and may not be added up
            sliced += plane && many ? 1 : 0;
            glm::dvec3 expected[9]{}, possible[9]{};  // lamps that give the threshold nowhere may be left out
            bool doubtful = false;
            for (uint32_t l = 0; plane && l < list.placed(); ++l) {
                const reference::OfPlace e = [&](glm::dvec2 p) {
                    return reference::light_on_plane(*plane, got.cluster.grid, list.lamps[l],
                                                     reference::kind_of(l, list.counts), p);
                };
                const reference::Extremes of = reference::extremes_of(block, e);
                const double threshold = double(got.cluster.threshold),
                             bearable = std::max(kTolerance * of.least, 0.25 * threshold);
                // Single precision: errors of a few 1e-6 of a value are a few 1e-3 of the tolerance.
                const auto is_resolved = [&](double slack) {
                    return reference::resolved(*plane, got.cluster.grid, block, list.lamps[l],
                                               reference::kind_of(l, list.counts), slack);
                };
                const bool smooth = of.least > 0 && of.error < bearable && is_resolved(1),
                           slight = std::none_of(block.pixels.begin(), block.pixels.end(), [&](glm::uvec2 p) {
                               return e(glm::dvec2(p) + 0.5) > 0.999 * threshold;
                           });
                const bool close =
                    std::abs(of.error - bearable) < 0.01 * bearable || is_resolved(0.999) != is_resolved(1.001);
                doubtful = doubtful || close;
                EXPECT_FALSE(smooth && !close && !many && listed.contains(l))
                    << "block " << b << ", lamp " << l << ", wrong by " << of.error << " lx";
                if (listed.contains(l) || !smooth) continue;
                ++taken;
                for (int n = 0; n < 9; ++n)
                    (slight ? possible : expected)[n] +=
                        e(reference::node(block, n % 3, n / 3)) * glm::dvec3(list.lamps[l].colour);
            }
            planes += plane ? 1 : 0;
            if (doubtful) continue;
            for (int n = 0; n < 9; ++n)
                for (int c = 0; c < 3; ++c) {  // 1e-4: positions on planes seen at grazing angles, in floats
                    const double sum = got.sum(b, n % 3, n / 3)[c], error = 1e-4 * expected[n][c] + 1e-6;
                    EXPECT_GE(sum, expected[n][c] - error) << "block " << b << ", node " << n;
                    EXPECT_LE(sum, expected[n][c] + possible[n][c] + error) << "block " << b << ", node " << n;
                }
        }
        if (far > 0) {
            EXPECT_GT(sliced, 0u);
        }
        if (extent.width > 100) {
            EXPECT_GT(planes, got.blocks.count / 3);
            EXPECT_GT(taken, planes) << "hardly anything was added up";
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Blocks, EveryBlockIsInItsClass) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {203, 131}}) {
        const Surfaces s = canyon(extent, 0, true, true);
        const Merged got = merge(rig, s, street_lamps({6, 5, 0}, 300, 2));
        std::vector<uint32_t> class_of_block(got.blocks.count, ~0u);
        for (uint32_t k = 0; k < shared::kBlockClasses; ++k) {
            const uint32_t* words = &got.class_counts[k * shared::kClassWords];
            EXPECT_EQ(words[0], (words[3] + shared::kBlocksPerGroup - 1) / shared::kBlocksPerGroup);
            EXPECT_EQ(words[1], 1u);
            EXPECT_EQ(words[2], 1u);
            for (uint32_t i = 0; i < words[3]; ++i) {
                const uint32_t block = got.class_blocks[k * got.blocks.count + i];
                ASSERT_LT(block, got.blocks.count);
                EXPECT_EQ(class_of_block[block], ~0u) << "block " << block << " is in two classes";
                class_of_block[block] = k;
            }
        }
        for (uint32_t b = 0; b < got.blocks.count; ++b)
            EXPECT_EQ(
                class_of_block[b],
                reference::class_of(block_of(s, b % got.blocks.columns, b / got.blocks.columns), got.listed(b) != 0))
                << "block " << b;
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Blocks, ANegativeToleranceAddsUpNothing) {
    PassRig rig;
    const Merged got = merge(rig, canyon({64, 40}), street_lamps({20, 20, 0}, 300, 3), -1);
    for (const glm::vec4& texel : got.sums) EXPECT_EQ(texel, glm::vec4(0));
    EXPECT_EQ(rig.complaints(), "");
}

// A polynomial is wrong by at most the tolerance at four pixels, by 1.1 times that at any other where light is cubic,
// and by 3.5 times where it has a kink, as at the edge of a ramp; of many lamps hardly any has one in a given block.
TEST(Blocks, ShadingWithSumsIsShadingLampByLamp) {
    PassRig rig;
    const Surfaces s = canyon({333, 211});
    const gpu_scene::LampList list = street_lamps({60, 60, 1}, 300, 7);
    for (const float far : {0.0f, 60.0f}) {
        const Shot merged = shade(rig, s, list, {.threshold = kAll, .far = far}, {}),
                   one_by_one = shade(rig, s, list, {.threshold = kAll, .far = far}, {.merge_error = 0});
        EXPECT_TRUE(same_light("merged", picture(s.extent, merged.pixels), picture(s.extent, one_by_one.pixels),
                               {1.2 * kTolerance, 1e-7}))
            << far;
        EXPECT_NE(merged.pixels, one_by_one.pixels) << "nothing was added up";
        const Shot again = shade(rig, s, list, {.threshold = kAll, .far = far}, {});
        EXPECT_EQ(merged.pixels, again.pixels) << "blocks come in any order, pictures may not tell";
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Where a lamp gives less than the threshold it may count or not: pictures lie between that without such light and that
// with all of it. An error of a quarter of the threshold on top is borne.
TEST(Blocks, LampsNearTheThresholdCountOrNot) {
    PassRig rig;
    const Surfaces s = canyon({333, 211}, 0, false);
    const gpu_scene::LampList list = street_lamps({60, 0, 0}, 300, 7);
    const float threshold = 0.5f;
    const Shot got = shade(rig, s, list, {.threshold = threshold}, {}),
               without = shade(rig, s, list, {.threshold = threshold}, {.merge_error = 0}),
               with = shade(rig, s, list, {.threshold = kAll}, {.merge_error = 0});
    size_t between = 0;
    for (size_t i = 0; i < got.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double error = 1.2 * double(kTolerance * with.pixels[i][c]) +
                                 60 * 0.25 * double(threshold) * 1.2 / 3.14159 * double(s.reflectance[i][c]);
            ASSERT_GE(got.pixels[i][c], double(without.pixels[i][c]) - error) << i;
            ASSERT_LE(got.pixels[i][c], double(with.pixels[i][c]) + error) << i;
            between += got.pixels[i][c] != without.pixels[i][c] ? 1 : 0;
        }
    EXPECT_GT(between, got.pixels.size() / 10);
    EXPECT_EQ(rig.complaints(), "");
}

// Ground that waves by 0.01 degrees under headlamps a hand above it: at 80 m the waves change light by percents.
TEST(Blocks, LightThatGrazesUnevenGroundIsShadedLampByLamp) {
    PassRig rig;
    Surfaces s = canyon({333, 211}, 0, false);
    for (size_t i = 0; i < s.surface.size(); ++i) {
        const double x = double(s.pixel(i).x), y = double(s.pixel(i).y);
        if (reference::octahedral_decode(glm::dvec2(s.surface[i])).y > 0.9)
            s.surface[i] = glm::vec4(glm::vec2(reference::octahedral_encode(
                                         glm::normalize(glm::dvec3(0, 1, 2e-4 * std::sin(0.5 * y + 0.1 * x))))),
                                     s.surface[i].z, 1);
    }
    gpu_scene::LampList list = street_lamps({2, 0, 0}, 1);
    for (int i = 0; i < 2; ++i)
        list.lamps[size_t(i)] = {{float(i) - 0.5f, -1.0f, -90}, 1e4f, {0, 0, 1}, 0, {1, 1, 1}, 1, {1, 0, 0}, -1};
    const Shot merged = shade(rig, s, list, {.threshold = kAll}, {}),
               one_by_one = shade(rig, s, list, {.threshold = kAll}, {.merge_error = 0});
    EXPECT_TRUE(same_light("uneven", picture(s.extent, merged.pixels), picture(s.extent, one_by_one.pixels),
                           {1.6 * kTolerance, 1e-7}));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Blocks, WhatIsNoNumberStaysInItsPixel) {
    PassRig rig;
    Surfaces s = canyon({61, 43}, 0, false);
    const gpu_scene::LampList list = street_lamps({20, 20, 0}, 300, 8);
    const Shot clean = shade(rig, s, list, {.threshold = kAll}, {});
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    const std::set<size_t> spoiled{0, 700, 1500, 2000, 2222, size_t(61 * 43 - 1)};
    const glm::vec4 broken[] = {{nan, 0, 5, 1}, {0, 0, nan, 1},      {0, 0, infinite, 1},
                                {0, 0, 5, nan}, {infinite, 0, 5, 1}, {0, nan, nan, nan}};
    uint32_t turn = 0;
    for (const size_t i : spoiled) s.surface[i] = broken[turn++];
    const Shot got = shade(rig, s, list, {.threshold = kAll}, {});
    for (size_t i = 0; i < got.pixels.size(); ++i)
        for (int c = 0; c < 3 && !spoiled.contains(i); ++c)  // its block is shaded lamp by lamp now
            EXPECT_NEAR(got.pixels[i][c], clean.pixels[i][c], 1.2 * kTolerance * std::abs(clean.pixels[i][c]) + 1e-7)
                << "pixel " << i;
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::blocks_test
