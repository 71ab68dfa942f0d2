// Random frames, run three times in a model of the device: whatever touches the same bytes must be in order, and
// whatever is read must have been written. SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "graph/declared_frame.h"

namespace vesper::test {
namespace {

using graph::Access, graph::Plan, graph::Resource, graph::Stage, graph::Use, graph::load, graph::sample, graph::store,
    graph::update;
using PassKind = graph::FrameGraph::PassKind;
using Origin = graph::FrameGraph::Origin;

constexpr int kGraphs = 400, kFrames = 3;

class RandomFrame : public DeclaredFrame {
public:
    explicit RandomFrame(uint32_t seed) : random_(seed) {
        const VkFormat formats[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
                                    VK_FORMAT_R32G32B32A32_SFLOAT};
        for (uint32_t i = 0; i < 3; ++i) images_.push_back(image("image " + std::to_string(i), formats[below(3)]));
        for (uint32_t i = 0; i < 4; ++i)
            buffers_.push_back(buffer("buffer " + std::to_string(i), 4096 * (1 + below(5))));
        histories_.push_back(graph.history("past buffer", graph::buffer_shape(64)));
        histories_.push_back(graph.history("past image", graph::image_shape(VK_FORMAT_R8G8B8A8_UNORM, kExtent)));
        upload_ = graph.upload("upload", std::vector<uint32_t>{1, 2, 3, 4});
        readback_ = graph.readback("readback", 64);
        written_.resize(graph.resources().size());
        if (below(2) == 0)
            measure = [](const graph::Shape& s, uint32_t) -> graph::Footprint {
                return {s.is_image() ? 8192u : s.bytes, s.is_image() ? 512u : 16u, s.is_image() ? 1u : 3u};
            };
        const uint32_t passes = 6 + below(20), first = below(passes), second = below(passes);
        for (uint32_t p = 0; p < passes; ++p) {
            add_random_pass("pass " + std::to_string(p));
            if (p == first) write("write past buffer", histories_[0].current);
            if (p == second) write("write past image", histories_[1].current);
        }
        write("write readback", readback_);
        for (const Resource r : images_)
            if (written_[r.index] && below(2) == 0) graph.keep(r);
        for (const Resource r : buffers_)
            if (written_[r.index] && below(2) == 0) graph.keep(r);
    }

private:
    uint32_t below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }

    void write(const std::string& name, Resource r) {
        compute(name, {load(upload_), store(r)});
        written_[r.index] = true;
    }

    Resource any() {
        const uint32_t i = below(12);
        if (i < 3) return images_[i];
        if (i < 7) return buffers_[i - 3];
        if (i < 9) return histories_[i - 7].previous;
        if (i < 11) return histories_[i - 9].current;
        return upload_;
    }

    bool holds_something(Resource r) const {
        const Origin origin = graph.resources()[r.index].origin;
        return written_[r.index] || origin == Origin::Upload || origin == Origin::HistoryPrevious;
    }

    /// A read or write of something not yet in `uses`; none if the draw was unlucky.
    void add_random_use(std::vector<Use>& uses) {
        const Resource r = any();
        if (std::ranges::any_of(uses, [&](const Use& u) { return u.resource == r; })) return;
        const Origin origin = graph.resources()[r.index].origin;
        const bool writable = origin != Origin::Upload && origin != Origin::HistoryPrevious;
        switch (below(8)) {
            case 0:
            case 1:
                if (holds_something(r)) uses.push_back(sample(r));
                break;
            case 2:
            case 3:
            case 4:
                if (holds_something(r)) uses.push_back(load(r));
                break;
            case 5:
                if (writable) uses.push_back(store(r));
                break;
            default:
                if (writable && holds_something(r)) uses.push_back(update(r));
        }
    }

    void add_random_pass(const std::string& name) {
        std::vector<Use> uses;
        switch (below(7)) {
            case 0: {
                const Resource target = images_[below(3)];
                uses.push_back(color(target));
                add_random_use(uses);
                draw(name, uses);
                break;
            }
            case 1: {
                uses.push_back({buffers_[below(4)], Access::CopyTarget});
                graph.clear(name, uses[0].resource);
                break;
            }
            default:
                while (uses.empty() || (uses.size() < 3 && below(4) != 0)) add_random_use(uses);
                compute(name, uses);
        }
        for (const Use& use : uses)
            if (graph::writes(use.access)) written_[use.resource.index] = true;
    }

    std::mt19937 random_;
    std::vector<Resource> images_, buffers_;
    std::vector<graph::History> histories_;
    Resource upload_, readback_;
    std::vector<bool> written_;
};

/// Bytes that two resources may share.
struct Place {
    uint32_t memory = 0;
    uint64_t low = 0, high = 1;
    bool meets(const Place& o) const { return memory == o.memory && low < o.high && o.low < high; }
};

/// Something that happens on the device: an access, or a barrier, which may also rewrite an image to change its layout.
struct Event {
    Place place;
    bool is_barrier = false;
    Stage stage{};
    Access access{};
    graph::AccessSet from, to;
    bool rewrites = false;
    std::string what;
};

bool meet(const graph::AccessSet& a, const graph::AccessSet& b) {
    for (uint32_t s = 0; s < 4; ++s)
        for (uint32_t x = 0; x < graph::kAccessCount; ++x)
            if (a.has(Stage(s), Access(x)) && b.has(Stage(s), Access(x))) return true;
    return false;
}

Stage stage_of(PassKind kind) {
    return kind == PassKind::Dispatch ? Stage::Compute : kind == PassKind::Raster ? Stage::Graphics : Stage::Transfer;
}

/// Where a resource lies in a given frame. The halves of a history change places; each frame has its own readbacks.
Place place_of(const graph::FrameGraph& graph, const Plan& plan, uint32_t resource, uint32_t frame) {
    for (const Plan::Placement& p : plan.placements)
        if (p.resource == resource) return {p.heap, p.offset, p.offset + p.bytes};
    const auto& r = graph.resources()[resource];
    if (r.partner == ~0u) return {1000 + 100 * frame + resource};
    const uint32_t half = r.origin == Origin::HistoryCurrent ? 1 : 0;
    return {100 + 2 * std::min(resource, r.partner) + ((half + frame) & 1u)};
}

/// Plays the plan, checking that images are in the layout they are used in.
std::vector<Event> play(const graph::FrameGraph& graph, const Plan& plan) {
    std::vector<Event> events;
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        std::map<uint32_t, VkImageLayout> layouts;
        const auto play_barrier = [&](const Plan::Barrier& b) {
            const auto& r = graph.resources()[b.resource];
            const std::string what = "barrier on " + r.name + " in frame " + std::to_string(frame);
            if (r.shape.is_image() && r.origin != Origin::Transient && !layouts.contains(b.resource))
                layouts[b.resource] = VK_IMAGE_LAYOUT_GENERAL;
            EXPECT_EQ(b.discard, r.origin == Origin::Transient && !layouts.contains(b.resource)) << what;
            if (!b.discard) {
                EXPECT_EQ(b.old_layout, layouts[b.resource]) << what;
            }
            layouts[b.resource] = b.new_layout;
            const bool rewrites = r.shape.is_image() && b.old_layout != b.new_layout;
            events.push_back({place_of(graph, plan, b.resource, frame), true, {}, {}, b.from, b.to, rewrites, what});
        };
        for (const Plan::Step& step : plan.steps) {
            const auto& pass = graph.passes()[step.pass];
            for (const Plan::Barrier& b : step.barriers) play_barrier(b);
            for (const Use& use : pass.uses) {
                const auto& r = graph.resources()[use.resource.index];
                const std::string what = pass.name + " on " + r.name + " in frame " + std::to_string(frame);
                if (r.shape.is_image() && (r.origin == Origin::Transient || layouts.contains(use.resource.index))) {
                    EXPECT_EQ(layouts[use.resource.index], graph::layout_of(use.access)) << what;
                }
                const Place place = place_of(graph, plan, use.resource.index, frame);
                events.push_back({place, false, stage_of(pass.kind), use.access, {}, {}, false, what});
            }
        }
        for (const Plan::Barrier& b : plan.final_barriers) {
            play_barrier(b);
            const Place place = place_of(graph, plan, b.resource, frame);
            events.push_back(
                {place, false, Stage::Host, Access::HostRead, {}, {}, false, "host in frame " + std::to_string(frame)});
        }
    }
    return events;
}

/// True if a chain of barriers on the bytes of both leads from event `first` to event `second`.
bool in_order(const std::vector<Event>& events, size_t first, size_t second) {
    const Event &a = events[first], &b = events[second];
    graph::AccessSet after = a.to;  // those that come after `a`: empty for an access
    const auto continues = [&](const Event& barrier) {
        return (!a.is_barrier && barrier.from.has(a.stage, a.access)) || meet(barrier.from, after);
    };
    for (size_t i = first + 1; i < second; ++i)
        if (events[i].is_barrier && events[i].place.meets(a.place) && events[i].place.meets(b.place) &&
            continues(events[i]))
            after.add(events[i].to);
    return b.is_barrier ? continues(b) : after.has(b.stage, b.access);
}

bool changes(const Event& event) { return event.is_barrier ? event.rewrites : graph::writes(event.access); }

TEST(PlanHazards, EveryTwoAccessesThatMustBeInOrderAre) {
    for (uint32_t seed = 0; seed < kGraphs; ++seed) {
        const RandomFrame f(seed);
        const std::vector<Event> events = play(f.graph, f.plan());
        for (size_t b = 0; b < events.size(); ++b) {
            if (events[b].is_barrier && !events[b].rewrites) continue;
            for (size_t a = 0; a < b; ++a) {
                if (events[a].is_barrier && !events[a].rewrites) continue;
                if (!events[a].place.meets(events[b].place) || (!changes(events[a]) && !changes(events[b]))) continue;
                ASSERT_TRUE(in_order(events, a, b))
                    << "seed " << seed << ": " << events[a].what << ", then " << events[b].what << "\n"
                    << f.text();
            }
        }
    }
}

TEST(PlanHazards, TransientsOfOverlappingLifetimesShareNoBytes) {
    for (uint32_t seed = 0; seed < kGraphs; ++seed) {
        const RandomFrame f(seed);
        const Plan plan = f.plan();
        const auto life = [&](uint32_t resource) {
            std::pair<size_t, size_t> steps{plan.steps.size(), 0};
            for (size_t s = 0; s < plan.steps.size(); ++s)
                for (const Use& use : f.graph.passes()[plan.steps[s].pass].uses)
                    if (use.resource.index == resource) steps = {std::min(steps.first, s), s};
            if (f.graph.resources()[resource].kept) steps.second = plan.steps.size();
            return steps;
        };
        uint64_t bytes = 0;
        for (const Plan::Placement& p : plan.placements) {
            const graph::Footprint footprint = f.measure(f.graph.resources()[p.resource].shape, plan.usage[p.resource]);
            bytes += p.bytes;
            ASSERT_EQ(p.offset % footprint.alignment, 0u) << "seed " << seed;
            ASSERT_EQ(plan.heaps[p.heap].memory_types, footprint.memory_types) << "seed " << seed;
            ASSERT_LE(p.offset + p.bytes, plan.heaps[p.heap].bytes) << "seed " << seed;
            for (const Plan::Placement& q : plan.placements) {
                if (&p == &q || p.heap != q.heap || p.offset >= q.offset + q.bytes || q.offset >= p.offset + p.bytes)
                    continue;
                const auto a = life(p.resource), b = life(q.resource);
                ASSERT_TRUE(a.second < b.first || b.second < a.first) << "seed " << seed << "\n" << f.text();
            }
        }
        ASSERT_EQ(bytes, plan.bytes_without_aliasing);
    }
}

/// Which pass wrote what each live pass finds, all passes run or only the live ones.
TEST(PlanHazards, DroppingPassesChangesNothingThatIsRead) {
    const auto partial = [](PassKind kind, Access access) {
        return graph::writes(access) && access != Access::CopyTarget &&
               !(access == Access::Store && kind == PassKind::Dispatch);
    };
    for (uint32_t seed = 0; seed < kGraphs; ++seed) {
        const RandomFrame f(seed);
        const Plan plan = f.plan();
        std::vector<bool> live(f.graph.passes().size(), true);
        for (const uint32_t p : plan.dropped) live[p] = false;
        std::map<uint32_t, std::vector<size_t>> writers;  // of what a resource holds now, oldest first
        const auto expect_live = [&](uint32_t resource) {
            for (const size_t p : writers[resource])
                EXPECT_TRUE(live[p]) << "seed " << seed << ": " << f.graph.passes()[p].name << "\n" << f.text();
        };
        for (size_t p = 0; p < live.size(); ++p) {
            const auto& pass = f.graph.passes()[p];
            for (const Use& use : pass.uses)
                if (live[p] && (!graph::writes(use.access) || partial(pass.kind, use.access)))
                    expect_live(use.resource.index);
            for (const Use& use : pass.uses) {
                if (!graph::writes(use.access)) continue;
                if (!partial(pass.kind, use.access)) writers[use.resource.index].clear();
                writers[use.resource.index].push_back(p);
            }
        }
        for (uint32_t r = 0; r < f.graph.resources().size(); ++r)
            if (f.graph.resources()[r].kept || f.graph.resources()[r].origin == Origin::HistoryCurrent) expect_live(r);
        if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace vesper::test
