// Light lists on the device: never a lamp too few, and what did not fit is said. SPDX-License-Identifier: MIT
#include "passes/cluster_reference.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/lamps.h"
#include "support/noise.h"
#include "support/texels.h"

namespace vesper::test::cluster_test {
namespace {

using gpu_scene::LampList;

struct Lists {
    shared::ClusterPush push;
    shared::ClusterReport report;
    std::vector<std::vector<uint32_t>> lamps;  ///< cones, then powers; of an overflowed froxel: empty
    std::vector<bool> overflowed;
    std::vector<uint32_t> cones;
    std::vector<reference::Drawn> drawn;  ///< what is drawn in a froxel
};

/// Depths of all sizes, m, and pixels without any: nothing is drawn in every third column of tiles beyond 30 m, nor
/// above tile 1 of every fifth.
std::vector<float> depths(VkExtent2D extent) {
    Noise random(extent.width);
    std::vector<float> depths;
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x) {
            const uint32_t column = reference::tile_of(x);
            const float depth = 0.3f * std::pow(1e5f, random.unit());
            const bool nothing = (column % 5 == 4 && reference::tile_of(y) < 1) || random.unit() < 0.1f;
            depths.push_back(nothing ? 0 : column % 3 == 2 ? std::min(depth, 30.0f) : depth);
        }
    return depths;
}

graph::Resource surface_of(graph::FrameGraph& graph, VkExtent2D extent) {
    std::vector<glm::vec4> texels;
    for (const float depth : depths(extent)) texels.emplace_back(0, 0, depth, 1);
    return PassRig::image(graph, "surface", render::kSurfaceFormat, extent, texels);
}

Lists cluster(PassRig& rig, const LampList& list, const gpu_scene::View& view,
              const render::ClusterSettings& settings) {
    graph::FrameGraph graph;
    const render::Clusters clusters =
        render::add_clusters(rig.frame(graph, view), surface_of(graph, view.extent), list, no_tables(graph), settings);
    const graph::Resource counts = keep<uint32_t>(graph, clusters.counts),
                          indices = keep<uint32_t>(graph, clusters.indices),
                          report = keep<shared::ClusterReport>(graph, clusters.report);
    rig.run(graph);

    Lists out;
    out.push = clusters.push;
    out.drawn = reference::drawn_in(out.push.grid, {view.extent.width, view.extent.height}, depths(view.extent));
    out.report = rig.got<shared::ClusterReport>(report).at(0);
    const auto count = rig.got<uint32_t>(counts), index = rig.got<uint32_t>(indices);
    const uint32_t capacity = out.push.grid.capacity;
    for (size_t froxel = 0; 2 * froxel < count.size(); ++froxel) {
        const bool over = count[2 * froxel] == shared::kAllLamps;
        EXPECT_EQ(over, count[2 * froxel + 1] == shared::kAllLamps);
        out.overflowed.push_back(over);
        out.cones.push_back(over ? 0 : count[2 * froxel]);
        const size_t begin = froxel * capacity, length = over ? 0 : count[2 * froxel] + count[2 * froxel + 1];
        EXPECT_LE(length, capacity);
        out.lamps.emplace_back(index.begin() + begin, index.begin() + begin + std::min<size_t>(length, capacity));
    }
    return out;
}

/// What must hold of any lists, whatever the lamps.
void expect_well_formed(const Lists& lists, const LampList& list) {
    const shared::ClusterGrid& grid = lists.push.grid;
    ASSERT_EQ(lists.lamps.size(), size_t(grid.tiles_x) * grid.tiles_y * grid.slices);
    uint64_t listed = 0, longest = 0, overflowed = 0;
    for (size_t i = 0; i < lists.lamps.size(); ++i) {
        const auto& l = lists.lamps[i];
        if (lists.drawn[i] == reference::Drawn::Nothing) {
            EXPECT_TRUE(l.empty() && !lists.overflowed[i]) << "froxel " << i;
        }
        const auto powers = l.begin() + lists.cones[i];
        EXPECT_TRUE(std::is_sorted(l.begin(), l.end())) << "froxel " << i;
        EXPECT_EQ(std::adjacent_find(l.begin(), l.end()), l.end()) << "froxel " << i << " has a lamp twice";
        EXPECT_TRUE(std::all_of(l.begin(), powers, [&](uint32_t k) { return k < list.counts.cones; }));
        EXPECT_TRUE(std::all_of(powers, l.end(), [&](uint32_t k) {
            return k >= list.counts.cones && k < list.counts.cones + list.counts.powers;
        }));
        listed += l.size(), longest = std::max<uint64_t>(longest, l.size()), overflowed += lists.overflowed[i];
    }
    EXPECT_EQ(lists.report.overflowed, overflowed);
    if (overflowed == 0) {
        EXPECT_EQ(lists.report.listed, listed);
        EXPECT_EQ(lists.report.longest, longest);
    } else {
        EXPECT_GT(lists.report.longest, grid.capacity);
        EXPECT_GT(lists.report.listed, listed);
    }
}

/// Every lamp that the reference found to light a froxel is on its list, and returns (found, listed) in total.
std::pair<uint64_t, uint64_t> expect_superset(const Lists& lists, const LampList& list, VkExtent2D extent, int steps) {
    const auto want = reference::lit_froxels(lists.push, {extent.width, extent.height}, list.lamps, steps);
    uint64_t found = 0, listed = 0, missed = 0;
    std::string first;
    for (size_t i = 0; i < want.size(); ++i) {
        if (lists.overflowed[i] || lists.drawn[i] != reference::Drawn::Something) continue;
        const auto& got = lists.lamps[i];
        found += want[i].size(), listed += got.size();
        for (uint32_t lamp : want[i])
            if (!std::binary_search(got.begin(), got.end(), lamp) && missed++ == 0)
                first = "froxel " + std::to_string(i) + " lacks lamp " + std::to_string(lamp);
    }
    EXPECT_EQ(missed, 0u) << first;
    return {found, listed};
}

gpu_scene::View view_of(VkExtent2D extent) { return gpu_scene::View::symmetric(extent, 0.7f, glm::mat4(1)); }

TEST(Cluster, ListsEveryLampThatLightsTheFroxel) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {65, 64}, {300, 190}})
        for (uint32_t count : {1u, 64u}) {
            SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height) + ", " +
                         std::to_string(count) + " lamps");
            const LampList list = street_lamps(half_and_half(count), 0.3f, extent.width + count);  // light radius 17 m
            const Lists lists = cluster(rig, list, view_of(extent), {});
            expect_well_formed(lists, list);
            expect_superset(lists, list, extent, 5);
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Cluster, ListsEveryLampOfAWholeFrame) {
    PassRig rig;
    const VkExtent2D extent{1680, 1050};
    const LampList list = street_lamps({20, 12, 0}, 0.3f, 4);
    const Lists lists = cluster(rig, list, view_of(extent), {});
    expect_well_formed(lists, list);
    // The bound is a sphere around each froxel, so lists are longer than they must be; but not so long as to be
    // useless.
    const auto [found, listed] = expect_superset(lists, list, extent, 3);
    EXPECT_GT(found, 0u);
    EXPECT_LT(listed, 4 * found);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Cluster, HoldsThousandsOfLamps) {
    PassRig rig;
    const VkExtent2D extent{130, 70};
    for (uint32_t count : {1000u, 4000u}) {
        const LampList list = street_lamps(half_and_half(count), 0.02f, count);
        const Lists lists = cluster(rig, list, view_of(extent), {.slices = 16, .capacity = count});
        EXPECT_EQ(lists.report.overflowed, 0u);
        expect_well_formed(lists, list);
        expect_superset(lists, list, extent, 3);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Cluster, BrightLampsReachTheEndOfTheStreet) {
    PassRig rig;
    const VkExtent2D extent{128, 64};
    const LampList list = street_lamps(half_and_half(16), 30000, 6);  // headlamps: 5.5 km
    const Lists lists = cluster(rig, list, view_of(extent), {});
    EXPECT_GT(lists.push.far, 5000);
    expect_well_formed(lists, list);
    expect_superset(lists, list, extent, 5);
    const Lists near = cluster(rig, list, view_of(extent), {.far = 500});
    EXPECT_FLOAT_EQ(near.push.far, 500);
    expect_superset(near, list, extent, 5);
    EXPECT_EQ(rig.complaints(), "");
}

// Beams narrower than a froxel: it is their direction that decides.
TEST(Cluster, NarrowBeamsAreFollowed) {
    PassRig rig;
    const VkExtent2D extent{190, 130};
    LampList list = street_lamps(half_and_half(120), 2e4f, 12);
    for (uint32_t i = 0; i < list.lamps.size(); ++i) {
        shared::Lamp& beam = list.lamps[i];
        const float inner = 0.003f, outer = 0.02f;
        beam.lobe_a = i < list.counts.cones ? 1 / (std::cos(inner) - std::cos(outer)) : 5000;
        beam.lobe_b = -std::cos(outer) * beam.lobe_a;
    }
    const Lists lists = cluster(rig, list, view_of(extent), {.slices = 24, .far = 300});
    expect_well_formed(lists, list);
    const auto [found, listed] = expect_superset(lists, list, extent, 3);
    EXPECT_GT(found, 200u);
    EXPECT_LT(listed, lists.lamps.size() * 120 / 4) << "most lamps are listed in few froxels";
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Cluster, SaysWhatDidNotFit) {
    PassRig rig;
    const VkExtent2D extent{200, 130};
    const LampList list = street_lamps(half_and_half(200), 1, 8);
    const Lists roomy = cluster(rig, list, view_of(extent), {.capacity = 200});
    EXPECT_EQ(roomy.report.overflowed, 0u);
    for (uint32_t capacity : {1u, 5u}) {
        const Lists tight = cluster(rig, list, view_of(extent), {.capacity = capacity});
        expect_well_formed(tight, list);
        uint64_t want = 0;
        for (size_t i = 0; i < roomy.lamps.size(); ++i) {
            const bool over = roomy.lamps[i].size() > capacity;
            want += over;
            EXPECT_EQ(tight.overflowed[i], over) << "froxel " << i;
            if (!over) {
                EXPECT_EQ(tight.lamps[i], roomy.lamps[i]);
            }
        }
        EXPECT_GT(want, 0u);
        EXPECT_EQ(tight.report.overflowed, want);
        EXPECT_EQ(tight.report.longest, roomy.report.longest);
        EXPECT_EQ(tight.report.listed, roomy.report.listed);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Cluster, AFrameWithoutLampsHasEmptyLists) {
    PassRig rig;
    for (const LampList& list : {LampList{}, street_lamps({0, 0, 2}, 1)}) {
        const Lists lists = cluster(rig, list, view_of({70, 40}), {});
        expect_well_formed(lists, list);
        EXPECT_EQ(lists.report.listed, 0u);
        EXPECT_EQ(lists.report.overflowed, 0u);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Cluster, ALampDarkerThanTheThresholdEverywhereIsNotListed) {
    PassRig rig;
    LampList list = street_lamps({1, 0, 0}, 1);
    list.lamps[0].position = {0, 0, -50};
    list.lamps[0].intensity = 0.001f;  // light radius 1 m
    const Lists lists = cluster(rig, list, view_of({64, 64}), {.far = 100});
    for (uint32_t slice = 0; slice < lists.push.grid.slices; ++slice) {
        const double begin = reference::slice_depth(lists.push.grid, slice),
                     end = reference::slice_depth(lists.push.grid, slice + 1);
        const auto& got = lists.lamps[reference::froxel_index(lists.push.grid, 0, 0, slice)];
        if (begin < 50 && end > 50 &&
            lists.drawn[reference::froxel_index(lists.push.grid, 0, 0, slice)] == reference::Drawn::Something) {
            EXPECT_EQ(got.size(), 1u);
        }
        if (end < 10) {
            EXPECT_TRUE(got.empty()) << "slice " << slice;
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Cluster, GridMapsDepthsFromAMetreToTheEnd) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::Clusters c =
        render::add_clusters(rig.frame(graph, view_of({1680, 1050})), surface_of(graph, {1680, 1050}),
                             street_lamps({3, 0, 0}, 100), no_tables(graph), {.far = 400});
    EXPECT_EQ(c.push.grid.tiles_x, 27u);
    EXPECT_EQ(c.push.grid.tiles_y, 17u);
    EXPECT_EQ(reference::slice_of(c.push.grid, 0.01), 0u);
    EXPECT_EQ(reference::slice_of(c.push.grid, 0.999), 0u);
    EXPECT_EQ(reference::slice_of(c.push.grid, 1.001), 1u);
    EXPECT_EQ(reference::slice_of(c.push.grid, 399.9), c.push.grid.slices - 1);
    EXPECT_NEAR(reference::slice_depth(c.push.grid, c.push.grid.slices), 400, 0.01);
}

TEST(Cluster, RefusesImpossibleSettings) {
    PassRig rig;
    graph::FrameGraph graph;
    const LampList list = street_lamps({3, 0, 0}, 100);
    const render::TableTexels tables = no_tables(graph);
    const graph::Resource surface = surface_of(graph, {64, 64});
    for (const render::ClusterSettings& settings :
         {render::ClusterSettings{.slices = 0}, render::ClusterSettings{.slices = 1},
          render::ClusterSettings{.slices = 33}, render::ClusterSettings{.capacity = 0}})
        EXPECT_THROW(render::add_clusters(rig.frame(graph, view_of({64, 64})), surface, list, tables, settings), Error);
    LampList crowd;
    crowd.counts.cones = 1u << 20, crowd.lamps.resize(1u << 20);
    EXPECT_THROW(render::add_clusters(rig.frame(graph, view_of({64, 64})), surface, crowd, tables, {}), Error);
}

}  // namespace
}  // namespace vesper::test::cluster_test
