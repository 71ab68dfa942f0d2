// From a declared frame to a plan: what is live, where it lies, what waits for what. SPDX-License-Identifier: MIT
#include "graph/frame_graph.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "base/error.h"

namespace vesper::graph {
namespace {

using PassInfo = FrameGraph::PassInfo;
using PassKind = FrameGraph::PassKind;
using ResourceInfo = FrameGraph::ResourceInfo;
using Origin = FrameGraph::Origin;

/// What the live steps do with a resource over the frame.
struct Life {
    uint32_t first = ~0u, last = 0;  ///< steps, counted from 1; 0: before them
    AccessSet accesses;

    bool used() const { return first != ~0u; }
    bool overlaps(const Life& o) const { return first <= o.last && o.first <= last; }
};

Stage stage_of(PassKind kind) {
    switch (kind) {
        case PassKind::Dispatch:
            return Stage::Compute;
        case PassKind::Raster:
            return Stage::Graphics;
        case PassKind::Transfer:
            return Stage::Transfer;
    }
    return Stage::Host;
}

/// True if nothing of the earlier contents survives. Fragments store only where they fall, and targets load.
bool replaces(PassKind kind, const Use& use) {
    return use.access == Access::CopyTarget || use.renew || (use.access == Access::Store && kind == PassKind::Dispatch);
}

/// True if earlier contents matter to this use.
bool needs_contents(PassKind kind, const Use& use) {
    return use.access != Access::Store ? !replaces(kind, use) : kind == PassKind::Raster;
}

/// Adds up what the uses of a pass move.
void count_bytes(const FrameGraph& graph, Plan::Step& step) {
    const PassInfo& pass = graph.passes()[step.pass];
    std::set<uint32_t> read, written;
    for (size_t i = 0; i < pass.uses.size(); ++i) {
        const Use& use = pass.uses[i];
        const auto [resource, access] = std::pair(use.resource, use.access);
        const uint64_t bytes = packed_bytes(graph.resources()[resource.index].shape);
        const bool target = access == Access::ColorTarget || access == Access::DepthTarget;
        const bool reads = target
                               ? !step.first_use[i] && !use.renew
                               : access != Access::Store && access != Access::CopyTarget && access != Access::CopyPart;
        if (reads && read.insert(resource.index).second) step.bytes_read += bytes;
        if (writes(access) && written.insert(resource.index).second) step.bytes_written += bytes;
    }
}

void check_written(const FrameGraph& graph) {
    std::vector<bool> written(graph.resources().size());
    for (const PassInfo& pass : graph.passes())
        for (const Use& use : pass.uses)
            if (writes(use.access)) written[use.resource.index] = true;
    for (size_t i = 0; i < written.size(); ++i) {
        const ResourceInfo& r = graph.resources()[i];
        if (written[i] || FrameGraph::is_filled(r.origin)) continue;
        if (r.origin == Origin::HistoryCurrent) throw Error("history '" + r.name + "' is written by no pass");
        if (r.kept) throw Error("resource '" + r.name + "' is kept but written by no pass");
    }
}

/// Walks backwards with the set of resources whose contents someone still wants.
std::vector<bool> find_live_passes(const FrameGraph& graph) {
    const auto& resources = graph.resources();
    std::vector<bool> wanted(resources.size()), live(graph.passes().size());
    for (size_t i = 0; i < resources.size(); ++i)
        wanted[i] = resources[i].kept || resources[i].origin == Origin::HistoryCurrent ||
                    resources[i].origin == Origin::Persistent;
    for (size_t p = live.size(); p-- > 0;) {
        const PassInfo& pass = graph.passes()[p];
        live[p] = std::ranges::any_of(pass.uses,
                                      [&](const Use& use) { return writes(use.access) && wanted[use.resource.index]; });
        if (!live[p]) continue;
        for (const Use& use : pass.uses)
            if (replaces(pass.kind, use)) wanted[use.resource.index] = false;
        for (const Use& use : pass.uses)
            if (needs_contents(pass.kind, use)) wanted[use.resource.index] = true;
    }
    return live;
}

/// Fills steps, dropped and usage, and tells how long each resource lives.
std::vector<Life> lay_out_steps(const FrameGraph& graph, Plan& plan) {
    const auto& resources = graph.resources();
    const std::vector<bool> live = find_live_passes(graph);
    std::vector<Life> lives(resources.size());
    plan.usage.assign(resources.size(), 0);
    for (uint32_t p = 0; p < live.size(); ++p) {
        if (!live[p]) {
            plan.dropped.push_back(p);
            continue;
        }
        const PassInfo& pass = graph.passes()[p];
        const uint32_t step = static_cast<uint32_t>(plan.steps.size());
        plan.steps.emplace_back().pass = p;
        for (size_t i = 0; i < pass.uses.size(); ++i) {
            const Use& use = pass.uses[i];
            Life& life = lives[use.resource.index];
            const ResourceInfo& r = resources[use.resource.index];
            plan.steps.back().first_use.push_back(!life.used() && !FrameGraph::is_filled(r.origin));
            life.first = std::min(life.first, step + 1);
            life.last = step + 1;
            life.accesses.add(stage_of(pass.kind), use.access);
            uint32_t& usage = plan.usage[use.resource.index];
            if (r.shape.is_image()) {
                usage |= image_usage_of(use.access);
            } else if (pass.kernel && i < pass.kernel->bindings.size()) {
                const VkDescriptorType type = pass.kernel->bindings[i];
                usage |= buffer_usage_of(use.access, type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER ||
                                                         type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER);
            } else {  // a recording binds as it likes
                usage |= buffer_usage_of(use.access, false);
                if (r.shape.format != VK_FORMAT_UNDEFINED) usage |= buffer_usage_of(use.access, true);
            }
        }
    }
    for (Plan::Step& step : plan.steps) count_bytes(graph, step);
    for (size_t i = 0; i < resources.size(); ++i) {
        // Whoever keeps a transient looks at it after the frame.
        if (resources[i].kept && lives[i].used()) lives[i].last = static_cast<uint32_t>(plan.steps.size());
        if (resources[i].reserved_usage) lives[i].first = 0, plan.usage[i] |= resources[i].reserved_usage;
        // The halves of a history change places every frame.
        if (resources[i].origin == Origin::HistoryCurrent)
            plan.usage[i] = plan.usage[resources[i].partner] |= plan.usage[i];
    }
    return lives;
}

uint64_t align_up(uint64_t value, uint64_t alignment) { return (value + alignment - 1) / alignment * alignment; }

/// The lowest offset at which `footprint` meets none of `others`, which are sorted by offset.
uint64_t first_fit(const Footprint& footprint, const std::vector<Plan::Placement>& others) {
    uint64_t offset = 0;
    for (const Plan::Placement& other : others) {
        if (offset + footprint.bytes <= other.offset) break;
        offset = std::max(offset, align_up(other.offset + other.bytes, footprint.alignment));
    }
    return offset;
}

uint32_t heap_for(uint32_t memory_types, std::vector<Plan::Heap>& heaps) {
    const auto found = std::ranges::find(heaps, memory_types, &Plan::Heap::memory_types);
    if (found == heaps.end()) heaps.push_back({memory_types, 0, 1});
    return static_cast<uint32_t>(std::ranges::find(heaps, memory_types, &Plan::Heap::memory_types) - heaps.begin());
}

/// Places live transients, largest first, each at the first offset free for its lifetime.
void place(const FrameGraph& graph, const Measure& measure, const std::vector<Life>& lives, Plan& plan) {
    std::vector<Footprint> footprints(lives.size());
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < lives.size(); ++i) {
        const ResourceInfo& r = graph.resources()[i];
        if (r.origin != Origin::Transient || !lives[i].used()) continue;
        footprints[i] = measure(r.shape, plan.usage[i]);
        footprints[i].alignment = std::max<uint64_t>(footprints[i].alignment, 1);
        if (footprints[i].bytes == 0 || footprints[i].memory_types == 0)
            throw Error("resource '" + r.name + "' fits no memory of the device");
        plan.bytes_without_aliasing += footprints[i].bytes;
        order.push_back(i);
    }
    std::ranges::stable_sort(order, [&](uint32_t a, uint32_t b) { return footprints[a].bytes > footprints[b].bytes; });
    for (const uint32_t resource : order) {
        const Footprint& footprint = footprints[resource];
        const uint32_t heap = heap_for(footprint.memory_types, plan.heaps);
        std::vector<Plan::Placement> others;
        for (const Plan::Placement& other : plan.placements)
            if (other.heap == heap && lives[other.resource].overlaps(lives[resource])) others.push_back(other);
        std::ranges::sort(others, {}, &Plan::Placement::offset);
        const uint64_t offset = first_fit(footprint, others);
        plan.placements.push_back({resource, heap, offset, footprint.bytes});
        plan.heaps[heap].bytes = std::max(plan.heaps[heap].bytes, offset + footprint.bytes);
        plan.heaps[heap].alignment = std::max(plan.heaps[heap].alignment, footprint.alignment);
    }
}

/// Where a resource stands between two steps.
struct State {
    AccessSet written;  ///< the last write, or what a later read may wait for in its place
    AccessSet since;    ///< every access since the last write, that one included
    AccessSet visible;  ///< reads that have already waited for it
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool fresh = false;  ///< a transient not yet used this frame
};

/// How buffers get what they hold before the frame: from passes of other frames and from copies. That these are over
/// does not make what they wrote visible.
AccessSet filled_before() {
    AccessSet set;
    set.add(Stage::Compute, Access::Update);
    set.add(Stage::Transfer, Access::CopyTarget);
    return set;
}

/// What stands between the frame's first use of each resource and the frame before it.
std::vector<State> start_of_frame(const FrameGraph& graph, const std::vector<Life>& lives, const Plan& plan) {
    std::vector<State> states(lives.size());
    for (uint32_t i = 0; i < states.size(); ++i) {
        const ResourceInfo& r = graph.resources()[i];
        if (r.external_image.image) states[i].layout = VK_IMAGE_LAYOUT_GENERAL;  // the border of the frame sees to that
        if (r.origin == Origin::External && !r.shape.is_image()) states[i].since = states[i].written = filled_before();
        if (r.origin == Origin::Persistent) {
            states[i].written = filled_before();
            states[i].written.add(lives[i].accesses);  // of the last frame
            states[i].since = states[i].written;
        }
        if (r.origin != Origin::HistoryPrevious && r.origin != Origin::HistoryCurrent) continue;
        // The other half was in this memory last frame; if it went untouched, this one the frame before.
        const AccessSet other = lives[r.partner].accesses;
        states[i].since = states[i].written = other.empty() ? lives[i].accesses : other;
        if (r.shape.is_image()) states[i].layout = VK_IMAGE_LAYOUT_GENERAL;
    }
    for (const Plan::Placement& own : plan.placements) {
        states[own.resource].fresh = true;
        for (const Plan::Placement& other : plan.placements)  // itself too: that was last frame
            if (own.heap == other.heap && own.offset < other.offset + other.bytes &&
                other.offset < own.offset + own.bytes)
                states[own.resource].since.add(lives[other.resource].accesses);
    }
    return states;
}

/// Whether the accesses in `to` must wait, and for what. Moves the state past them.
bool advance(State& state, const std::vector<Access>& accesses, Stage stage, bool image, Plan::Barrier& barrier) {
    bool writing = false, unseen = false;
    for (const Access access : accesses) {
        barrier.to.add(stage, access);
        writing = writing || writes(access);
        unseen = unseen || !state.visible.has(stage, access);
    }
    barrier.discard = state.fresh;
    barrier.old_layout = state.layout;
    barrier.new_layout = image ? layout_of(accesses.front()) : VK_IMAGE_LAYOUT_UNDEFINED;
    const bool changes_layout = barrier.old_layout != barrier.new_layout;
    // A layout change rewrites the image, so it too waits for the readers.
    barrier.from = writing || changes_layout ? state.since : state.written;
    const bool needed = state.fresh || changes_layout || (!barrier.from.empty() && (writing || unseen));

    if (writing || changes_layout) {
        // After a layout change a later read waits for whoever waited for the change.
        state.written = state.since = barrier.to;
        state.visible = writing ? AccessSet{} : barrier.to;
    } else {
        state.since.add(barrier.to);
        state.visible.add(barrier.to);
    }
    state.layout = barrier.new_layout;
    state.fresh = false;
    return needed;
}

void synchronize(const FrameGraph& graph, const std::vector<Life>& lives, Plan& plan) {
    std::vector<State> states = start_of_frame(graph, lives, plan);
    for (Plan::Step& step : plan.steps) {
        const PassInfo& pass = graph.passes()[step.pass];
        for (size_t i = 0; i < pass.uses.size(); ++i) {
            const Resource resource = pass.uses[i].resource;
            // A resource read through several bindings waits once, at the first of them.
            const auto same = [&](const Use& use) { return use.resource == resource; };
            if (std::any_of(pass.uses.begin(), pass.uses.begin() + static_cast<ptrdiff_t>(i), same)) continue;
            std::vector<Access> accesses;
            for (const Use& use : pass.uses)
                if (same(use)) accesses.push_back(use.access);
            Plan::Barrier barrier;
            barrier.resource = resource.index;
            const bool image = graph.resources()[resource.index].shape.is_image();
            if (advance(states[resource.index], accesses, stage_of(pass.kind), image, barrier))
                step.barriers.push_back(barrier);
        }
    }
    for (uint32_t i = 0; i < states.size(); ++i) {
        if (graph.resources()[i].origin != Origin::Readback) continue;
        Plan::Barrier barrier;
        barrier.resource = i;
        if (advance(states[i], {Access::HostRead}, Stage::Host, false, barrier)) plan.final_barriers.push_back(barrier);
    }
}

std::string barrier_text(const FrameGraph& graph, const Plan::Barrier& barrier) {
    return "    " + graph.resources()[barrier.resource].name + ": " + (barrier.discard ? "new after " : "") +
           barrier.from.text() + " -> " + barrier.to.text() + "\n";
}

}  // namespace

Plan FrameGraph::compile(const Measure& measure) const {
    check_written(*this);
    Plan plan;
    const std::vector<Life> lives = lay_out_steps(*this, plan);
    place(*this, measure, lives, plan);
    synchronize(*this, lives, plan);
    return plan;
}

std::string FrameGraph::describe(const Plan& plan) const {
    std::string text;
    for (const Plan::Step& step : plan.steps) {
        text += passes_[step.pass].name + "\n";
        for (const Plan::Barrier& barrier : step.barriers) text += barrier_text(*this, barrier);
    }
    if (!plan.final_barriers.empty()) text += "after the frame\n";
    for (const Plan::Barrier& barrier : plan.final_barriers) text += barrier_text(*this, barrier);
    for (size_t i = 0; i < plan.dropped.size(); ++i)
        text += (i == 0 ? "dropped: " : ", ") + passes_[plan.dropped[i]].name;
    if (!plan.dropped.empty()) text += "\n";

    std::vector<Plan::Placement> placements = plan.placements;
    std::ranges::sort(placements, [](const Plan::Placement& a, const Plan::Placement& b) {
        return std::tie(a.heap, a.offset, a.resource) < std::tie(b.heap, b.offset, b.resource);
    });
    uint32_t heap = ~0u;
    for (const Plan::Placement& p : placements) {
        if (plan.heaps.size() > 1 && p.heap != heap) text += "heap " + std::to_string(p.heap) + ":\n";
        heap = p.heap;
        text += resources_[p.resource].name + " @ " + std::to_string(p.offset) + " + " + std::to_string(p.bytes) + "\n";
    }
    uint64_t bytes = 0;
    for (const Plan::Heap& h : plan.heaps) bytes += h.bytes;
    return text + "heap " + std::to_string(bytes) + " of " + std::to_string(plan.bytes_without_aliasing) + " bytes\n";
}

}  // namespace vesper::graph
