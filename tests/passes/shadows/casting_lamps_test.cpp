// Lamps that cast no shadows, on the device: those that the reference leaves out. SPDX-License-Identifier: MIT
#include "passes/shadows/casting_lamps_reference.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "render/shadows/casting_lamps.h"
#include "support/lamps.h"
#include "support/shading.h"

namespace vesper::test::casting_lamps_test {
namespace {

constexpr float kThreshold = 1e-6f;  // lx

/// A road 1.2 m under the eye and a wall 40 m away; some pixels hold nothing, or no numbers.
Surfaces road(VkExtent2D extent) {
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.7f, glm::mat4(1));
    Surfaces s{extent, {}, {}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const glm::dvec2 ray =
            glm::dvec2(view.ray_scale()) * (glm::dvec2(s.pixel(i)) + 0.5) + glm::dvec2(view.ray_offset());
        const double on_road = ray.y < 0 ? 1.2 / -ray.y : 1e6, depth = std::min(on_road, 40.0);
        const glm::dvec3 normal = on_road < 40 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
        const glm::uvec2 block = s.pixel(i) / 8u;
        float z = float(depth);
        if ((block.x + block.y) % 7 == 3) z = 0;
        if ((block.x + block.y) % 7 == 5) z = std::numeric_limits<float>::quiet_NaN();
        s.reflectance.emplace_back(0.5f, 0.5f, 0.5f, 0.0f);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(normal)), z, 1.0f);
        s.emission.emplace_back(0);
    }
    return s;
}

/// The mean over the middle pixels of every `step`-th block, by the reference.
std::vector<double> shares_of(const Surfaces& s, const gpu_scene::LampList& list, const shared::ClusterGrid& grid,
                              uint32_t step) {
    std::vector<double> mean(list.lamps.size());
    uint32_t blocks = 0;
    for (uint32_t y = 0; y < s.extent.height; y += 8 * step)
        for (uint32_t x = 0; x < s.extent.width; x += 8 * step, ++blocks) {
            const glm::uvec2 pixel(std::min(x + 4, s.extent.width - 1), std::min(y + 4, s.extent.height - 1));
            const glm::vec4 surface = s.surface[size_t(pixel.y) * s.extent.width + pixel.x];
            if (!(surface.z > 0)) continue;
            const std::vector<double> here = reference::light_shares(
                list.lamps, list.counts, reference::view_position(grid, glm::dvec2(pixel) + 0.5, double(surface.z)),
                reference::octahedral_decode(glm::dvec2(surface)), double(kThreshold));
            for (size_t i = 0; i < mean.size(); ++i) mean[i] += here[i];
        }
    for (double& share : mean) share /= blocks;
    return mean;
}

struct Kept {
    std::vector<uint32_t> left_out;
    shared::VisibilityReport report;
    shared::ClusterGrid grid;
};

Kept casting(PassRig& rig, const Surfaces& s, const gpu_scene::LampList& list, const std::vector<uint32_t>& optional,
             float most) {
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, gpu_scene::View::symmetric(s.extent, 0.7f, glm::mat4(1)));
    const render::GBuffer g = upload(graph, s);
    const render::Clusters clusters =
        render::add_clusters(frame, g.surface, list, no_tables(graph), {.threshold = kThreshold});
    const render::Blocks blocks = render::add_blocks(frame, g, clusters);
    std::vector<shared::ShadowMap> maps(list.lamps.size());
    for (size_t i = 0; i < maps.size(); ++i) maps[i] = {{0, 0, 0, 1}, float(i), i == 1 ? 0.0f : 64.0f, 1, 0};
    const graph::Resource made = keep<shared::ShadowMap>(
        graph, render::add_casting_lamps(frame, {g, clusters, blocks}, maps, optional, most, maps.size()));
    const graph::Resource report = keep<shared::VisibilityReport>(graph, blocks.visibility);
    rig.run(graph);
    Kept kept{{}, rig.got<shared::VisibilityReport>(report).at(0), clusters.push.grid};
    const std::vector<shared::ShadowMap> got = rig.got<shared::ShadowMap>(made);
    for (uint32_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i].first, maps[i].first);
        EXPECT_EQ(got[i].zoom, maps[i].zoom);
        if (got[i].side == 0 && i != 1) kept.left_out.push_back(i);
    }
    return kept;
}

// The bounds lie a little below sums of shares, so that single precision decides as double does.
TEST(CastingLamps, AreAllButTheFaintest) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {8, 8}, {203, 131}, {1208, 904}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        const Surfaces s = road(extent);
        const gpu_scene::LampList list = street_lamps({20, 20, 0}, 300, extent.width);
        std::vector<uint32_t> optional;
        for (uint32_t i = 0; i < 40; i += 3) optional.push_back(i);
        const uint32_t step = extent.width * extent.height > 64 * 16384 ? 2 : 1;
        const std::vector<double> shares = shares_of(s, list, casting(rig, s, list, {}, 1).grid, step);
        std::vector<double> order;
        for (const uint32_t lamp : optional) order.push_back(shares[lamp]);
        std::ranges::sort(order);
        double sum = 0;
        for (size_t k = 0; k + 1 < order.size(); ++k) {
            sum += order[k];
            if (order[k + 1] < 1e-4 || order[k + 1] < 1.02 * order[k]) continue;  // two that single precision may turn
            const double most = sum + 0.985 * order[k + 1];
            const Kept got = casting(rig, s, list, optional, float(most));
            std::vector<uint32_t> want = reference::unshadowed(shares, optional, most);
            std::ranges::sort(want);
            EXPECT_EQ(got.left_out, want) << most;
            EXPECT_EQ(got.report.unshadowed, want.size());
            EXPECT_NEAR(got.report.unshadowed_light, 1e6 * sum, 2e-3 * 1e6 * sum + double(want.size()));
        }
        EXPECT_TRUE(casting(rig, s, list, {}, 1).left_out.empty());
        const std::vector<uint32_t> all = casting(rig, s, list, optional, 1).left_out;
        EXPECT_EQ(all, optional) << "all that may be";
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::casting_lamps_test
