#include "render/shadows/shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "render/shadows/caster_parts.h"
#include "render/shadows/casters.h"

namespace vesper::render {
namespace {

constexpr double kFaintestMoving = 0.1;    // lx: light below, of a lamp that moves, casts no shadow
constexpr double kLeastShare = 1.0 / 100;  // of the light at a moving placement: below, it casts no shadow

// At whatever extent.
bool sees_the_same(const gpu_scene::View& a, const gpu_scene::View& b) {
    return a.world_to_view == b.world_to_view && a.tangent_low == b.tangent_low && a.tangent_high == b.tangent_high;
}

uint64_t changed_bytes(uint64_t texels) {
    const uint64_t tiles = texels / shared::kTileTexels;
    return (shared::kChangedHead + tiles) * sizeof(uint32_t) + tiles * sizeof(shared::ChangedTile);
}

// Memory of maps of so many texels: two atlases, the list of changed tiles, and the buffers that they are drawn in.
uint64_t bytes_of(uint64_t texels) {
    constexpr uint64_t kRounding = 256 << 10;  // of all buffers, as a device may want
    return 2 * texels * sizeof(uint16_t) + changed_bytes(texels) + ShadowMapScratch::bytes(texels) + kRounding;
}

// Of all maps, in this memory (MiB) and in buffers of the device.
uint64_t most_texels(const gpu::Device& device, uint32_t memory) {
    const uint64_t most = std::min({device.most_texels(sizeof(uint16_t)),
                                    uint64_t{device.limits().maxStorageBufferRange} / sizeof(uint16_t),
                                    uint64_t{kMostGroups} * shared::kTileTexels});  // a workgroup puts a tile back
    uint64_t fits = 0, tiles = most / shared::kTileTexels;
    while (fits < tiles) {
        const uint64_t middle = (fits + tiles + 1) / 2;
        if (bytes_of(middle * shared::kTileTexels) <= uint64_t{memory} << 20u) {
            fits = middle;
        } else {
            tiles = middle - 1;
        }
    }
    return fits * shared::kTileTexels;
}

ShadowAtlas make_atlas(const gpu::Device& device, const ShadowMapPlan& plan, const ShadowMapSizes& sizes) {
    const uint64_t most = most_texels(device, sizes.memory);
    return {plan.layouts, scene_scale(plan, most) + std::log2(sizes.resolution), most};
}

}  // namespace

ShadowMaps::ShadowMaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
                       const std::vector<gpu_scene::PlacedLamp>& lamps, const ShadowMapPlan& plan,
                       const ShadowMapSizes& sizes)
    : resident_(resident),
      lamps_(lamps),
      fixtures_(plan.fixtures),
      sizes_(sizes),
      atlas_(make_atlas(device, plan, sizes)),
      moving_(resident, plan.animated),
      arena_(device, 0),
      maps_(lamps.size()),
      device_(device),
      everything_(resident.placements().size()) {
    still_ = make_shadow_texels(device, arena_, atlas_.texels());
    distances_ = make_shadow_texels(device, arena_, atlas_.texels());
    changed_ = gpu::make_buffer(
        device, changed_bytes(atlas_.texels()),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    arena_.bind(changed_.get());
    std::iota(everything_.begin(), everything_.end(), 0u);
}

void ShadowMaps::plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
                      double caster_error, float unshadowed_share) {
    report_ = {};
    maps_to_draw_.clear();
    if (std::exchange(caster_error_, caster_error) != caster_error)
        for (uint32_t lamp = 0; lamp < maps_.size(); ++lamp) maps_[lamp].drawn &= !moves(lamp);
    update_light(list, view, unshadowed_share);
    update_view(view, poses);
    std::vector<bool> moving;
    for (uint32_t lamp = 0; lamp < lamps_.size(); ++lamp) {
        moving.push_back(moves(lamp));
        if (moves(lamp) && !std::exchange(maps_[lamp].moves, true)) maps_[lamp].drawn = false;
    }
    std::optional<ShadowAtlas::Change> change = atlas_.fit(list, moving);
    if (!change)
        throw Error("shadow maps of " + std::to_string(list.placed()) + " lamps do not fit --shadow-memory " +
                    std::to_string(sizes_.memory) + " (MiB) on this device, at the least side of " +
                    std::to_string(kLeastMapSide) +
                    " texels; with more, or with --shadows off, the scene can be rendered");
    moves_ = std::move(change->moves);
    for (const uint32_t lamp : change->lamps) maps_[lamp].drawn = false;
    plan_maps(list);
    const auto stands = [&](uint32_t lamp) { return !moves(lamp); };
    bodies_ = bodies_in_light(list, view);
    draws_bodies_ =
        bodies_ != drawn_bodies_ || !moves_.empty() || (!bodies_.empty() && std::ranges::any_of(maps_to_draw_, stands));
    find_cached(poses);
    report_.maps = uint32_t(maps_to_draw_.size());
    for (const auto& [lamp, placements] : bodies_) report_.bodies += draws_bodies_ ? uint32_t(placements.size()) : 0;
    report_.bytes = arena_.bytes() + ShadowMapScratch::bytes(atlas_.texels());
}

void ShadowMaps::update_light(const gpu_scene::LampList& list, const gpu_scene::View& view, float unshadowed_share) {
    const auto bytes = [](const auto& lamps) { return std::as_bytes(std::span(lamps)); };
    is_same_light_ = unshadowed_share_ == unshadowed_share && sees_the_same(view_, view) &&
                     view_.extent.width == view.extent.width && view_.extent.height == view.extent.height &&
                     std::ranges::equal(bytes(lamps_seen_), bytes(list.lamps));
    unshadowed_share_ = unshadowed_share;
    lamps_seen_ = list.lamps;
}

void ShadowMaps::update_view(const gpu_scene::View& view, const gpu_scene::SceneFrame& poses) {
    const uint64_t version = moving_.version();
    forget_still(moving_.update(poses));
    if (moving_.version() != version) {
        culling_ = culling_ == ViewCulling::Off ? ViewCulling::Pending : ViewCulling::On;
    } else if (!sees_the_same(view_, view)) {
        culling_ = ViewCulling::Off;
    }
    view_ = view;
}

// Maps that may hold placements which have begun to move are drawn without them.
void ShadowMaps::forget_still(const std::vector<uint32_t>& placements) {
    if (placements.empty()) return;
    for (Map& map : maps_) map.drawn = false;
    surroundings_.reset(), groups_.reset();
}

void ShadowMaps::plan_maps(const gpu_scene::LampList& list) {
    for (const uint32_t lamp : std::span(list.indices).first(list.placed())) {
        if (atlas_[lamp].side == 0) continue;
        ++report_.lamps;
        const Map& map = maps_[lamp];
        if (!map.drawn || (moves(lamp) && is_out_of_date(map))) maps_to_draw_.push_back(lamp);
    }
}

// Bodies before lamps at rest that light them.
ShadowMaps::Bodies ShadowMaps::bodies_in_light(const gpu_scene::LampList& list, const gpu_scene::View& view) const {
    Bodies lit;
    std::vector<double> light(list.placed());  // lx
    for (const MovingPlacements::Moving& body : moving_.moving()) {
        const glm::dvec3 in_view(view.world_to_view * glm::dvec4(body.centre, 1));
        double sum = 0;
        for (uint32_t i = 0; i < list.placed(); ++i) {
            const uint32_t lamp = list.indices[i];
            const glm::dvec3 to = in_view - glm::dvec3(list.lamps[i].position);
            const double away = glm::length(to), nearest = std::max(away - body.radius, 0.1 * body.radius);
            const bool reached = !moves(lamp) && atlas_[lamp].side > 0 &&
                                 away - body.radius < double(atlas_[lamp].range) &&
                                 !std::ranges::binary_search(fixtures_[lamp], body.placement);
            const double candela = reached ? intensity_towards(list, i, to, body.radius) : 0;
            light[i] = candela / std::max(nearest * nearest, 1e-6);
            sum += candela / std::max(away * away, body.radius * body.radius);
        }
        for (uint32_t i = 0; i < list.placed(); ++i)
            if (light[i] > kLeastShare * sum && light[i] > kFaintestLight)
                lit[list.indices[i]].emplace_back(body.placement, body.version);
    }
    return lit;
}

ShadowMapToDraw ShadowMaps::map_of(uint32_t lamp, const gpu_scene::SceneFrame& poses) const {
    return {.layout = atlas_[lamp],
            .frame = map_frame(poses.world[lamps_[lamp].node]),
            .fixture = fixtures_[lamp],
            .placements = moves(lamp) ? std::span<const uint32_t>(everything_) : moving_.still(),
            .caster_error = moves(lamp) ? caster_error_ : 0};
}

uint32_t ShadowMaps::number_of(uint32_t lamp, const gpu_scene::LampList& list) {
    return uint32_t(std::ranges::find(list.indices, lamp) - list.indices.begin());
}

// Those of a lamp that moves.
IsCaster ShadowMaps::casters_of(uint32_t lamp, const Declared& to) const {
    const glm::dvec3 position(to.poses.world[lamps_[lamp].node][3]);
    return {{number_of(lamp, to.list), position, atlas_[lamp], kFaintestMoving}, to.list, view_, culls()};
}

// Takes maps that the cache has out of those to be drawn.
void ShadowMaps::find_cached(const gpu_scene::SceneFrame& poses) {
    cached_ = {};
    if (!cache_ || maps_to_draw_.empty()) return;
    if (!surroundings_) surroundings_ = shadow_surroundings(device_, resident_, moving_.still(), poses);
    const auto is_cached = [&](uint32_t lamp) {
        return !moves(lamp) && cached_.find(*cache_, shadow_map_key(*surroundings_, map_of(lamp, poses)), atlas_[lamp]);
    };
    std::vector<uint32_t> missing;
    uint64_t texels = 0;
    for (const uint32_t lamp : maps_to_draw_) texels += moves(lamp) ? 0 : atlas_[lamp].texels();
    cached_.found.reserve(texels * sizeof(uint16_t));
    for (const uint32_t lamp : maps_to_draw_) {
        if (!is_cached(lamp)) {
            missing.push_back(lamp);
            continue;
        }
        maps_[lamp] = {.drawn = true, .version = moving_.version()};
        copied_.push_back(lamp);
        ++report_.cached;
    }
    maps_to_draw_ = std::move(missing);
}

// Tiles that what moves was drawn into are as they are without it.
void ShadowMaps::declare_restoring(const Declared& to) {
    graph::FrameGraph& graph = to.frame.graph;
    if (std::exchange(lists_nothing_, false)) {
        const uint32_t tiles = uint32_t(atlas_.texels() / shared::kTileTexels);
        graph.clear("clear changed tiles", to.scratch.changed);
        graph.copy("begin changed tiles", graph.upload("no changed tiles", std::vector<uint32_t>{0, 1, 1, tiles}),
                   to.scratch.changed, {{0, 0, shared::kChangedHead * sizeof(uint32_t)}});
    } else if (draws_bodies_) {
        restore_shadow_maps(to.frame, to.still, to.distances, to.scratch);
    }
}

// From one atlas to the other, so that no map is overwritten before it has moved: without what moves both hold the
// same, but for maps of lamps that move, which only one has.
void ShadowMaps::declare_moves(const Declared& to) {
    if (moves_.empty()) return;
    std::vector<graph::Region> out, back;
    for (const graph::Region& move : moves_) {
        out.push_back({move.from, move.from, move.bytes});
        back.push_back({move.to, move.to, move.bytes});
    }
    graph::FrameGraph& graph = to.frame.graph;
    graph.copy("move shadow maps out", to.distances, to.still, std::move(out));
    graph.copy("move shadow maps", to.still, to.distances, std::exchange(moves_, {}));
    graph.copy("move shadow maps back", to.distances, to.still, std::move(back));
}

// Maps of lamps that stand still, which are copied to those with what moves.
void ShadowMaps::declare_still_maps(const Declared& to) {
    cached_.upload(to.frame.graph, to.still);
    std::vector<ShadowMapToDraw> maps;
    for (const uint32_t lamp : maps_to_draw_) {
        if (moves(lamp)) continue;
        maps.push_back(map_of(lamp, to.poses));
        maps_[lamp] = {.drawn = true, .version = moving_.version()};
        copied_.push_back(lamp);
    }
    if (!maps.empty()) add_shadow_maps(to.frame, resident_, to.poses, nullptr, maps, to.still, to.scratch);
    cached_.read_back(to.frame.graph, to.still);
    std::vector<graph::Region> made;
    for (const uint32_t lamp : std::exchange(copied_, {})) {
        const uint64_t at = atlas_[lamp].first * sizeof(uint16_t);
        made.push_back({at, at, atlas_[lamp].texels() * sizeof(uint16_t)});
    }
    if (!made.empty()) to.frame.graph.copy("copy shadow maps", to.still, to.distances, std::move(made));
}

// Maps of lamps that move, and what moves before the others.
void ShadowMaps::declare_what_moves(const Declared& to) {
    std::vector<ShadowMapToDraw> maps;
    std::vector<uint32_t> moving;
    for (const MovingPlacements::Moving& body : moving_.moving()) moving.push_back(body.placement);
    for (const uint32_t lamp : std::exchange(maps_to_draw_, {})) {
        if (!moves(lamp)) continue;
        ShadowMapToDraw& map = maps.emplace_back(map_of(lamp, to.poses));
        map.is_caster = casters_of(lamp, to), map.number = number_of(lamp, to.list);
        if (caster_error_ > 0) map.placements = moving;
        maps_[lamp] = {
            .drawn = true, .moves = true, .culled = culls(), .optional = may_leave_out(), .version = moving_.version()};
    }
    if (!maps.empty()) {
        if (!groups_) groups_.emplace(resident_, moving_.still(), to.poses);
        add_shadow_maps(to.frame, resident_, to.poses, &*groups_, maps, to.distances, to.scratch);
    }
    if (!std::exchange(draws_bodies_, false)) return;
    drawn_bodies_ = bodies_;
    maps.clear();
    std::vector<std::vector<uint32_t>> placements;
    for (const auto& [lamp, bodies] : bodies_) {
        std::vector<uint32_t>& of_map = placements.emplace_back();
        for (const auto& [placement, version] : bodies) of_map.push_back(placement);
        maps.push_back(map_of(lamp, to.poses));
    }
    for (size_t i = 0; i < maps.size(); ++i) maps[i].placements = placements[i];
    add_over_shadow_maps(to.frame, resident_, to.poses, maps, to.distances, to.scratch);
}

graph::Resource ShadowMaps::lamps_of(const Declared& to, const BlockLists* lists) const {
    std::vector<shared::ShadowMap> maps;
    std::vector<uint32_t> optional;
    for (const uint32_t lamp : std::span(to.list.indices).first(to.list.placed())) {
        if (moves(lamp)) optional.push_back(uint32_t(maps.size()));
        maps.push_back(shadow_map(atlas_[lamp], map_frame(to.poses.world[lamps_[lamp].node]), view_));
    }
    if (lists && may_leave_out() && !moving_.moving().empty())
        return add_casting_lamps(to.frame, *lists, maps, std::move(optional), unshadowed_share_, lamps_.size());
    return to.frame.graph.upload("shadow maps", maps, VK_FORMAT_R32G32B32A32_SFLOAT);
}

FrameShadowMaps ShadowMaps::declare(const FrameContext& frame, const gpu_scene::LampList& list,
                                    const gpu_scene::SceneFrame& poses, const BlockLists* lists) {
    const uint64_t bytes = atlas_.texels() * sizeof(uint16_t);
    const graph::Resource still = frame.graph.persistent("distances of what stands still", still_, bytes),
                          distances = frame.graph.persistent("distances", distances_, bytes, VK_FORMAT_R16_SFLOAT);
    const graph::Resource changed = frame.graph.persistent("changed tiles", changed_, changed_bytes(atlas_.texels()));
    Declared to{frame, list,      poses,
                still, distances, add_shadow_map_scratch(frame, resident_, changed, atlas_.texels())};
    declare_restoring(to);
    declare_moves(to);
    declare_still_maps(to);
    if (list.placed() > 0) to.scratch.lamps = lamps_of(to, lists);
    declare_what_moves(to);
    return list.placed() > 0 ? FrameShadowMaps{to.scratch.lamps, distances} : FrameShadowMaps{};
}

void ShadowMaps::forget() {
    for (Map& map : maps_) map.drawn = false;
    cached_ = {};
    moves_.clear(), maps_to_draw_.clear(), copied_.clear(), drawn_bodies_.clear();
    draws_bodies_ = false, lists_nothing_ = true;
}

std::string ShadowMaps::keep(const ShadowCache& drawn, const graph::Executor& executor) const {
    return cache_ ? drawn.store(*cache_, executor) : std::string();
}

}  // namespace vesper::render
