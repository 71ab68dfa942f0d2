// The rules of the graph's compiler, one test each, as the text of plans. SPDX-License-Identifier: MIT
#include "graph/plan.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "gpu/memory.h"
#include "graph/declared_frame.h"

namespace vesper::test {
namespace {

using graph::Plan, graph::Resource, graph::load, graph::sample, graph::store, graph::update;

TEST(Plan, OfASmallFrame) {
    DeclaredFrame f;
    const Resource lamps = f.graph.upload("lamps", std::vector<uint32_t>{1, 2, 3});
    const Resource surface = f.image("surface"), z = f.image("depth", VK_FORMAT_D32_SFLOAT);
    const Resource scene = f.image("scene", VK_FORMAT_R16G16B16A16_SFLOAT), display = f.image("display");
    const Resource counts = f.buffer("counts", 1024), unread = f.image("unread");
    const graph::History eye = f.graph.history("eye", graph::buffer_shape(8));
    const Resource pixels = f.graph.readback("pixels", 8192);
    f.draw("gbuffer", {color(surface), depth(z)});
    f.compute("shade", {sample(surface), sample(z), load(lamps), store(scene)});
    f.compute("debug", {sample(scene), store(unread)});
    f.graph.clear("zero", counts);
    f.compute("histogram", {sample(scene), update(counts)});
    f.compute("adapt", {load(counts), load(eye.previous), store(eye.current)});
    f.compute("composite", {sample(scene), load(eye.current), store(display)});
    f.graph.copy("read back", display, pixels);
    EXPECT_EQ(f.text(), R"(gbuffer
    surface: new after compute sample|compute load|compute store|compute update|graphics color-target|transfer copy-source|transfer copy-target -> graphics color-target
    depth: new after compute sample|graphics depth-target -> graphics depth-target
shade
    surface: graphics color-target -> compute sample
    depth: graphics depth-target -> compute sample
    scene: new after compute sample|compute store -> compute store
zero
    counts: new after compute sample|compute load|compute store|compute update|graphics color-target|transfer copy-source|transfer copy-target -> transfer copy-target
histogram
    scene: compute store -> compute sample
    counts: transfer copy-target -> compute update
adapt
    counts: compute update -> compute load
    eye (previous): compute load|compute store -> compute load
    eye: compute load -> compute store
composite
    eye: compute store -> compute load
    display: new after compute sample|compute load|compute store|compute update|graphics color-target|transfer copy-source|transfer copy-target -> compute store
read back
    display: compute store -> transfer copy-source
after the frame
    pixels: transfer copy-target -> host read
dropped: debug
scene @ 0 + 16384
surface @ 16384 + 8192
display @ 16384 + 8192
counts @ 16384 + 1024
depth @ 24576 + 8192
heap 32768 of 41984 bytes
)");
}

TEST(Plan, ReadAfterEqualReadDoesNotWait) {
    DeclaredFrame f;
    const Resource a = f.buffer("a"), b = f.buffer("b"), c = f.buffer("c");
    f.graph.keep(b), f.graph.keep(c);
    f.compute("write", {store(a)});
    f.compute("first", {load(a), store(b)});
    f.compute("second", {load(a), store(c)});
    const Plan plan = f.plan();
    ASSERT_EQ(plan.steps.size(), 3u);
    EXPECT_EQ(plan.steps[1].barriers.size(), 2u);
    ASSERT_EQ(plan.steps[2].barriers.size(), 1u);
    EXPECT_EQ(plan.steps[2].barriers[0].resource, c.index);
}

TEST(Plan, AReadInAnotherStageWaitsForTheWriteAlone) {
    DeclaredFrame f;
    const Resource a = f.buffer("a"), b = f.buffer("b"), target = f.image("target");
    f.graph.keep(b), f.graph.keep(target);
    f.compute("write", {store(a)});
    f.compute("read", {load(a), store(b)});
    f.draw("draw", {color(target), vertices(a)});
    const Plan plan = f.plan();
    ASSERT_EQ(plan.steps[2].barriers.size(), 2u);
    EXPECT_EQ(plan.steps[2].barriers[1].from.text(), "compute store");
    EXPECT_EQ(plan.steps[2].barriers[1].to.text(), "graphics vertices");
}

TEST(Plan, AWriteWaitsForEveryReaderAndTheWriteBefore) {
    DeclaredFrame f;
    const Resource a = f.buffer("a"), b = f.buffer("b"), target = f.image("target");
    f.graph.keep(a), f.graph.keep(b), f.graph.keep(target);
    f.compute("write", {store(a)});
    f.compute("read", {load(a), store(b)});
    f.draw("draw", {color(target), vertices(a)});
    f.compute("add", {update(a)});
    const Plan plan = f.plan();
    ASSERT_EQ(plan.steps[3].barriers.size(), 1u);
    EXPECT_EQ(plan.steps[3].barriers[0].from.text(), "compute load|compute store|graphics vertices");
    EXPECT_EQ(plan.steps[3].barriers[0].to.text(), "compute update");
}

TEST(Plan, WriteAfterWriteWaits) {
    DeclaredFrame f;
    const Resource a = f.buffer("a");
    f.graph.keep(a);
    f.graph.clear("zero", a);
    f.compute("add", {update(a)});
    f.compute("add more", {update(a)});
    EXPECT_EQ(f.text(), R"(zero
    a: new after compute update|transfer copy-target -> transfer copy-target
add
    a: transfer copy-target -> compute update
add more
    a: compute update -> compute update
a @ 0 + 256
heap 256 of 256 bytes
)");
}

TEST(Plan, AResourceReadTwiceByOnePassWaitsOnce) {
    DeclaredFrame f;
    const Resource a = f.image("a"), b = f.image("b");
    f.graph.keep(b);
    f.compute("write", {store(a)});
    f.compute("read", {sample(a), load(a), store(b)});
    const Plan plan = f.plan();
    ASSERT_EQ(plan.steps[1].barriers.size(), 2u);
    EXPECT_EQ(plan.steps[1].barriers[0].to.text(), "compute sample|compute load");
}

TEST(Plan, LayoutsChangeForTargetsOnly) {
    DeclaredFrame f;
    const Resource a = f.image("a"), b = f.image("b");
    f.graph.keep(a), f.graph.keep(b);
    f.compute("write", {store(a)});
    f.draw("draw", {color(a)});
    f.draw("draw more", {color(a)});
    f.compute("read", {sample(a), store(b)});
    const Plan plan = f.plan();
    const auto& made = plan.steps[0].barriers[0];
    EXPECT_TRUE(made.discard);
    EXPECT_EQ(made.old_layout, VK_IMAGE_LAYOUT_UNDEFINED);
    EXPECT_EQ(made.new_layout, VK_IMAGE_LAYOUT_GENERAL);
    const auto& drawn = plan.steps[1].barriers[0];
    EXPECT_FALSE(drawn.discard);
    EXPECT_EQ(drawn.old_layout, VK_IMAGE_LAYOUT_GENERAL);
    EXPECT_EQ(drawn.new_layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    const auto& again = plan.steps[2].barriers[0];
    EXPECT_EQ(again.old_layout, again.new_layout);
    const auto& read = plan.steps[3].barriers[0];
    EXPECT_EQ(read.old_layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    EXPECT_EQ(read.new_layout, VK_IMAGE_LAYOUT_GENERAL);
}

TEST(Plan, TargetsAreClearedOnTheirFirstUseOnly) {
    DeclaredFrame f;
    const Resource a = f.image("a"), z = f.image("z", VK_FORMAT_D32_SFLOAT);
    f.graph.keep(a);
    f.draw("near", {color(a), depth(z)});
    f.draw("far", {color(a), depth(z)});
    const Plan plan = f.plan();
    EXPECT_EQ(plan.steps[0].first_use, (std::vector<bool>{true, true}));
    EXPECT_EQ(plan.steps[1].first_use, (std::vector<bool>{false, false}));
}

TEST(Plan, CountsWhatEachPassMoves) {
    DeclaredFrame f;
    const Resource lamps = f.graph.upload("lamps", std::vector<uint32_t>{1, 2, 3});
    const Resource surface = f.image("surface"), z = f.image("z", VK_FORMAT_D32_SFLOAT),
                   scene = f.image("scene", VK_FORMAT_R16G16B16A16_SFLOAT);
    const Resource counts = f.buffer("counts", 100), pixels = f.graph.readback("pixels", 16384);
    f.graph.keep(counts);
    f.draw("near", {color(surface), depth(z)});
    f.draw("far", {color(surface), depth(z)});
    f.compute("shade", {sample(surface), load(surface), load(lamps), store(scene)});
    f.graph.clear("zero", counts);
    f.compute("count", {sample(scene), update(counts)});
    f.graph.copy("read back", scene, pixels);
    const Plan plan = f.plan();
    constexpr uint64_t kSurface = 64 * 32 * 4, kDepth = kSurface, kScene = 64 * 32 * 8;
    const uint64_t expected[][2]{{0, kSurface + kDepth},  {kSurface + kDepth, kSurface + kDepth},
                                 {kSurface + 12, kScene}, {0, 100},
                                 {kScene + 100, 100},     {kScene, kScene}};
    ASSERT_EQ(plan.steps.size(), std::size(expected));
    for (size_t i = 0; i < std::size(expected); ++i) {
        EXPECT_EQ(plan.steps[i].bytes_read, expected[i][0]) << i;
        EXPECT_EQ(plan.steps[i].bytes_written, expected[i][1]) << i;
    }
}

TEST(Plan, UploadsNeedNoBarrier) {
    DeclaredFrame f;
    const Resource lamps = f.graph.upload("lamps", std::vector<uint32_t>{1}), a = f.buffer("a");
    f.graph.keep(a);
    f.compute("read", {load(lamps), store(a)});
    const Plan plan = f.plan();
    ASSERT_EQ(plan.steps[0].barriers.size(), 1u);
    EXPECT_EQ(plan.steps[0].barriers[0].resource, a.index);
    EXPECT_EQ(plan.steps[0].first_use, (std::vector<bool>{false, true}));
}

TEST(Plan, HistoryWaitsForTheLastFrameAndKeepsItsContents) {
    DeclaredFrame f;
    const graph::History eye = f.graph.history("eye", graph::image_shape(VK_FORMAT_R32_SFLOAT, {4, 4}));
    const Resource out = f.graph.readback("out", 64);
    f.compute("adapt", {load(eye.previous), store(eye.current)});
    f.graph.copy("read back", eye.current, out);
    EXPECT_EQ(f.text(), R"(adapt
    eye (previous): compute store|transfer copy-source -> compute load
    eye: compute load -> compute store
read back
    eye: compute store -> transfer copy-source
after the frame
    out: transfer copy-target -> host read
heap 0 of 0 bytes
)");
    const Plan plan = f.plan();
    for (const auto& barrier : plan.steps[0].barriers) {
        EXPECT_FALSE(barrier.discard);
        EXPECT_EQ(barrier.old_layout, VK_IMAGE_LAYOUT_GENERAL);
        EXPECT_EQ(barrier.new_layout, VK_IMAGE_LAYOUT_GENERAL);
    }
    EXPECT_EQ(plan.usage[eye.previous.index], plan.usage[eye.current.index]) << "they change places";
}

TEST(Plan, AHistoryWhosePreviousIsNotReadWaitsForItselfTwoFramesAgo) {
    DeclaredFrame f;
    const graph::History eye = f.graph.history("eye", graph::buffer_shape(8));
    f.compute("adapt", {store(eye.current)});
    EXPECT_EQ(f.text(), "adapt\n    eye: compute store -> compute store\nheap 0 of 0 bytes\n");
}

TEST(Plan, APersistentBufferIsWhatTheFrameIsMadeForAndWaitsForTheLastFrame) {
    DeclaredFrame f;
    const gpu::OwnedBuffer none;
    const Resource maps = f.graph.persistent("maps", none, 8);
    const Resource unread = f.buffer("unread");
    f.compute("look", {load(maps), store(unread)});
    f.compute("draw", {update(maps)});
    EXPECT_EQ(
        f.text(),
        "draw\n    maps: compute update|transfer copy-target -> compute update\ndropped: look\nheap 0 of 0 bytes\n");
    EXPECT_FALSE(f.plan().steps[0].barriers[0].discard);
}

// Maps are drawn by a frame of their own and read by the next: a fence alone makes nothing visible to caches.
TEST(Plan, AnExternalBufferIsReadAfterWhatFilledIt) {
    DeclaredFrame f;
    const gpu::OwnedBuffer none;
    const Resource maps = f.graph.external("maps", none, 8), seen = f.buffer("seen"), more = f.buffer("more");
    f.graph.keep(more);
    f.compute("look", {load(maps), store(seen)});
    f.compute("look again", {load(maps), load(seen), store(more)});
    const std::vector<Plan::Step> steps = f.plan().steps;
    ASSERT_EQ(steps.size(), 2u);
    const auto waits_for_maps = [&](const Plan::Barrier& b) { return b.resource == maps.index; };
    const auto barrier = std::ranges::find_if(steps[0].barriers, waits_for_maps);
    ASSERT_NE(barrier, steps[0].barriers.end());
    EXPECT_EQ(barrier->from.text(), "compute update|transfer copy-target");
    EXPECT_EQ(barrier->to.text(), "compute load");
    EXPECT_TRUE(std::ranges::none_of(steps[1].barriers, waits_for_maps)) << "once is enough";
}

TEST(Plan, DropsWhatFeedsNothingKept) {
    DeclaredFrame f;
    const Resource a = f.buffer("a"), b = f.buffer("b"), c = f.buffer("c"), d = f.buffer("d");
    f.graph.keep(b);
    f.compute("a", {store(a)});
    f.compute("b", {load(a), store(b)});
    f.compute("c", {load(b), store(c)});
    f.compute("d", {load(c), store(d)});
    f.compute("reader", {load(b)});
    const Plan plan = f.plan();
    EXPECT_EQ(plan.steps.size(), 2u);
    EXPECT_EQ(plan.dropped, (std::vector<uint32_t>{2, 3, 4}));
    EXPECT_EQ(plan.usage[c.index], 0u);
    EXPECT_EQ(plan.placements.size(), 2u);
}

TEST(Plan, DropsAWriterWhoseWorkIsReplacedUnread) {
    DeclaredFrame f;
    const Resource a = f.buffer("a");
    f.graph.keep(a);
    f.compute("lost", {store(a)});
    f.compute("base", {store(a)});
    f.compute("added to", {update(a)});
    EXPECT_EQ(f.plan().dropped, (std::vector<uint32_t>{0}));
}

TEST(Plan, KeepsAReplacedWriterThatMakesSomethingElse) {
    DeclaredFrame f;
    const Resource a = f.buffer("a"), b = f.buffer("b");
    f.graph.keep(a), f.graph.keep(b);
    f.compute("both", {store(a), store(b)});
    f.compute("again", {store(a)});
    EXPECT_TRUE(f.plan().dropped.empty());
}

TEST(Plan, KeepsWhatADrawDrawsOver) {
    DeclaredFrame f;
    const Resource a = f.image("a");
    f.graph.keep(a);
    f.compute("background", {store(a)});
    f.draw("over", {color(a)});
    EXPECT_TRUE(f.plan().dropped.empty());
}

TEST(Plan, PlacesTheLargestFirstWhereLifetimesAllow) {
    DeclaredFrame f;
    const Resource small = f.buffer("small", 100), large = f.buffer("large", 1000), late = f.buffer("late", 500);
    const Resource out = f.buffer("out", 40);
    f.graph.keep(out);
    f.compute("1", {store(small)});
    f.compute("2", {load(small), store(large)});
    f.compute("3", {load(large), store(late)});
    f.compute("4", {load(late), store(out)});
    EXPECT_EQ(f.text(), R"(1
    small: new after compute load|compute store -> compute store
2
    small: compute store -> compute load
    large: new after compute load|compute store -> compute store
3
    large: compute store -> compute load
    late: new after compute load|compute store -> compute store
4
    late: compute store -> compute load
    out: new after compute load|compute store -> compute store
large @ 0 + 1000
out @ 0 + 40
small @ 1008 + 100
late @ 1008 + 500
heap 1508 of 1640 bytes
)");
}

TEST(Plan, KeptTransientsLastToTheEndOfTheFrame) {
    DeclaredFrame f;
    const Resource kept = f.buffer("kept"), other = f.buffer("other"), out = f.graph.readback("out", 256);
    f.graph.keep(kept);
    f.compute("make", {store(kept)});
    f.compute("work", {store(other)});
    f.graph.copy("read back", other, out);
    const Plan plan = f.plan();
    ASSERT_EQ(plan.placements.size(), 2u);
    EXPECT_NE(plan.placements[0].offset, plan.placements[1].offset);
}

TEST(Plan, HasAHeapForEachKindOfMemory) {
    DeclaredFrame f;
    const Resource image = f.image("image"), buffer = f.buffer("buffer");
    f.graph.keep(buffer);
    f.compute("1", {store(image)});
    f.compute("2", {load(image), store(buffer)});
    f.measure = [](const graph::Shape& shape, uint32_t) -> graph::Footprint {
        return shape.is_image() ? graph::Footprint{8192, 4096, 2} : graph::Footprint{256, 16, 6};
    };
    const Plan plan = f.plan();
    ASSERT_EQ(plan.heaps.size(), 2u);
    EXPECT_EQ(plan.heaps[0].memory_types, 2u);
    EXPECT_EQ(plan.heaps[0].alignment, 4096u);
    EXPECT_EQ(plan.heaps[1].bytes, 256u);
    const std::string text = f.graph.describe(plan);
    EXPECT_NE(text.find("heap 0:\nimage @ 0 + 8192\nheap 1:\nbuffer @ 0 + 256\nheap 8448 of 8448 bytes\n"), text.npos)
        << text;
}

TEST(Plan, UsageFollowsTheBindings) {
    DeclaredFrame f;
    const Resource texels = f.graph.transient("texels", graph::buffer_shape(64, VK_FORMAT_R32_UINT));
    const Resource image = f.image("image"), out = f.graph.readback("out", 8192);
    f.compute("1", {store(texels)});
    f.compute("2", {sample(texels), store(image)});
    f.graph.copy("read back", image, out);
    const Plan plan = f.plan();
    EXPECT_EQ(plan.usage[texels.index], VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    EXPECT_EQ(plan.usage[image.index], VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    EXPECT_EQ(plan.usage[out.index], VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

TEST(Plan, ArgumentsWaitForTheirWriter) {
    DeclaredFrame f;
    const Resource counts = f.buffer("counts", 64), out = f.buffer("out");
    const gpu::KernelInterface kernel{"k.comp", {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, 4, {1, 1, 1}};
    f.compute("count", {store(counts)});
    f.graph.dispatch("work", kernel, {store(out)}, 1u, graph::Arguments{counts, 16});
    f.graph.keep(out);
    const std::string text = f.text();
    EXPECT_NE(text.find("    counts: compute store -> compute arguments\n"), text.npos) << text;
    EXPECT_TRUE(f.plan().usage[counts.index] & VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    const Plan plan = f.plan();
    for (const Plan::Barrier& barrier : plan.steps[1].barriers)
        if (barrier.resource == counts.index) {
            EXPECT_EQ(barrier.to.stages(), VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
            EXPECT_EQ(barrier.to.accesses(), VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
        }
}

TEST(AccessSet, TurnsIntoVulkan) {
    graph::AccessSet set;
    EXPECT_TRUE(set.empty());
    EXPECT_EQ(set.text(), "nothing");
    set.add(graph::Stage::Compute, graph::Access::Load);
    EXPECT_FALSE(set.writes());
    EXPECT_EQ(set.stages(), VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    EXPECT_EQ(set.accesses(), VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    set.add(graph::Stage::Graphics, graph::Access::DepthTarget);
    EXPECT_TRUE(set.writes());
    EXPECT_EQ(set.text(), "compute load|graphics depth-target");
    EXPECT_NE(set.stages() & VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, 0u);
    EXPECT_EQ(graph::layout_of(graph::Access::DepthTarget), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
    EXPECT_EQ(graph::layout_of(graph::Access::Sample), VK_IMAGE_LAYOUT_GENERAL);
}

// Passes that only some frames have change no place of other resources.
TEST(Plan, AReservedTransientKeepsItsPlace) {
    const auto placed = [](bool used) {
        DeclaredFrame f;
        const Resource lamps = f.graph.upload("lamps", std::vector<uint32_t>{1, 2, 3});
        const Resource scratch = f.graph.reserved("scratch", graph::image_shape(VK_FORMAT_D32_SFLOAT, kExtent),
                                                  {graph::Access::DepthTarget, graph::Access::Sample});
        const Resource words = f.graph.reserved("words", graph::buffer_shape(4096), {graph::Access::Store});
        const gpu::OwnedBuffer none;
        const Resource maps = f.graph.persistent("maps", none, 8);
        for (int i = 0; used && i < 2; ++i) {
            f.draw("draw maps", {{scratch, graph::Access::DepthTarget, {}, true}});
            f.compute("store maps", {sample(scratch), update(maps), store(words)});
        }
        const Resource scene = f.image("scene", VK_FORMAT_R16G16B16A16_SFLOAT), display = f.image("display");
        f.graph.keep(display);
        f.compute("shade", {load(lamps), store(scene)});
        f.compute("composite", {sample(scene), store(display)});
        const Plan plan = f.plan();
        std::map<std::string, std::pair<uint64_t, uint32_t>> places;
        for (const Plan::Placement& p : plan.placements)
            places[f.graph.resources()[p.resource].name] = {p.offset, plan.usage[p.resource]};
        return places;
    };
    const auto without = placed(false);
    EXPECT_EQ(without.size(), 4u);
    EXPECT_EQ(without, placed(true));
    EXPECT_NE(without.at("scratch").first, without.at("words").first) << "both may be in use at once";
    EXPECT_EQ(without.at("scene").first, 0u) << "nothing is reserved while the frame is rendered";
}

// Each image is drawn anew: what was drawn before need not be kept for it.
TEST(Plan, ATargetThatIsRenewedKeepsNothing) {
    DeclaredFrame f;
    const Resource target = f.image("target", VK_FORMAT_D32_SFLOAT), out = f.buffer("out");
    f.graph.keep(out);
    f.draw("unseen", {{target, graph::Access::DepthTarget}});
    f.draw("seen", {{target, graph::Access::DepthTarget, {}, true}});
    f.compute("look", {sample(target), store(out)});
    EXPECT_NE(f.text().find("dropped: unseen"), std::string::npos);
}

// A copy of parts leaves the rest as it was, so passes that wrote the rest run, too.
TEST(Plan, ACopyOfPartsKeepsTheRest) {
    DeclaredFrame f;
    const Resource from = f.buffer("from"), to = f.buffer("to");
    f.graph.keep(to);
    f.compute("fill", {store(from)});
    f.compute("fill the rest", {store(to)});
    f.graph.copy("part", from, to, {{0, 128, 64}, {64, 0, 64}});
    EXPECT_EQ(f.text().find("dropped"), std::string::npos);
    EXPECT_NE(f.text().find("to: compute store -> transfer copy-part"), std::string::npos);
}

}  // namespace
}  // namespace vesper::test
