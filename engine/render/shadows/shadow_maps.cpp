#include "render/shadows/shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>

#include "render/shadows/caster_parts.h"
#include "render/shadows/casters.h"

namespace vesper::render {
namespace {

// Of drawing a whole map, in tiles: all that stands around its lamp takes more time than its texels.
uint64_t cost_of(const ShadowMapLayout& layout) {
    constexpr uint64_t kLeast = 128;
    return std::max<uint64_t>(layout.texels() / ShadowAtlas::kTileTexels, kLeast);
}

constexpr double kFaintestMoving = 0.1;    // lx: light below, of a lamp that moves, casts no shadow
constexpr double kLeastShare = 1.0 / 100;  // of the light at a moving placement: below, it casts no shadow

}  // namespace

ShadowMaps::ShadowMaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
                       const std::vector<gpu_scene::PlacedLamp>& lamps, const ShadowMapPlan& plan, double resolution)
    : resident_(resident),
      lamps_(lamps),
      fixtures_(plan.fixtures),
      atlas_(plan.layouts, plan.scale + std::log2(resolution)),
      moving_(resident, plan.animated),
      arena_(device),
      maps_(lamps.size()),
      device_(device),
      everything_(resident.placements().size()) {
    distances_ = make_shadow_texels(device, arena_, atlas_.texels());
    std::iota(everything_.begin(), everything_.end(), 0u);
}

void ShadowMaps::plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
                      uint64_t budget, double caster_error) {
    report_ = {};
    maps_to_draw_.clear();
    if (std::exchange(caster_error_, caster_error) != caster_error)
        for (uint32_t lamp = 0; lamp < maps_.size(); ++lamp) maps_[lamp].drawn &= !is_whole(lamp);
    update_view(view, poses);
    const uint64_t most_texels = budget == kUnlimited ? budget : budget / 2 * ShadowAtlas::kTileTexels;
    std::vector<bool> moving;
    for (uint32_t lamp = 0; lamp < lamps_.size(); ++lamp) moving.push_back(moves(lamp));
    ShadowAtlas::Change change = atlas_.fit(list, most_texels, moving);
    moves_ = std::move(change.moves);
    for (const uint32_t lamp : change.lamps) {
        release_tiles(lamp);
        maps_[lamp].drawn = maps_[lamp].whole = false;
    }
    plan_new_maps(list, budget);
    // A quarter is for maps alone, so that they are reached.
    uint64_t for_tiles = budget - budget / 4;
    budget -= for_tiles;
    plan_tiles(dynamic_tiles(list, poses, view), list, for_tiles);
    current_ = most_texels == kUnlimited;
    plan_moved_maps(list, budget + for_tiles);
    find_cached(poses);
    report_.maps = uint32_t(maps_to_draw_.size());
    report_.tiles = uint32_t(tiles_to_draw_.size());
    report_.bytes = arena_.bytes();
}

void ShadowMaps::update_view(const gpu_scene::View& view, const gpu_scene::SceneFrame& poses) {
    const uint64_t version = moving_.version();
    forget_still(moving_.update(poses));
    if (moving_.version() != version) {
        culling_ = culling_ == ViewCulling::Off ? ViewCulling::Pending : ViewCulling::On;
    } else if (view.world_to_view != view_.world_to_view || view.tangent_low != view_.tangent_low ||
               view.tangent_high != view_.tangent_high) {
        culling_ = ViewCulling::Off;
    }
    view_ = view;
}

// Maps that may hold placements which have begun to move are drawn without them.
void ShadowMaps::forget_still(const std::vector<uint32_t>& placements) {
    if (placements.empty()) return;
    for (Map& map : maps_) map.drawn = false;
    surroundings_.reset();
}

void ShadowMaps::release_tiles(uint32_t lamp) {
    const auto first = tiles_.lower_bound({lamp, false, 0, 0}), end = tiles_.lower_bound({lamp + 1, false, 0, 0});
    for (auto at = first; at != end; ++at) atlas_.release(at->second.saved);
    tiles_.erase(first, end);
}

// Maps that hold nothing yet.
void ShadowMaps::plan_new_maps(const gpu_scene::LampList& list, uint64_t& budget) {
    for (uint32_t i = 0; i < list.placed(); ++i) {
        const uint32_t lamp = list.indices[i];
        if (atlas_[lamp].side == 0) continue;
        ++report_.lamps;
        if (is_whole(lamp)) release_tiles(lamp);
        if (maps_[lamp].drawn) continue;
        maps_to_draw_.push_back(lamp);
        budget -= std::min(budget, cost_of(atlas_[lamp]));
        release_tiles(lamp);
    }
}

// Of maps of lamps that move, those first whose light is nearest to the eye.
void ShadowMaps::plan_moved_maps(const gpu_scene::LampList& list, uint64_t budget) {
    std::vector<std::pair<double, uint32_t>> moved;
    for (uint32_t i = 0; i < list.placed(); ++i) {
        const uint32_t lamp = list.indices[i];
        if (atlas_[lamp].side > 0 && maps_[lamp].drawn && is_whole(lamp) && is_out_of_date(maps_[lamp]) &&
            std::ranges::find(maps_to_draw_, lamp) == maps_to_draw_.end()) {
            const double away = double(glm::length(list.lamps[i].position));
            const double priority = double(list.lamps[i].intensity) / std::max(away * away, 1.0);
            const auto deferred = deferred_maps_.find(lamp);
            moved.emplace_back(-priority * (deferred == deferred_maps_.end() ? 1 : 1 + deferred->second), lamp);
        }
    }
    std::ranges::sort(moved);
    bool any = false;  // one is drawn in any case, so that none waits for ever
    for (const auto& [priority, lamp] : moved) {
        const uint64_t cost = cost_of(atlas_[lamp]);
        const bool of_other_view = maps_[lamp].culled && !current_;  // it may lack casters of this view
        if (cost > budget && (any || budget == 0) && !of_other_view) {
            ++report_.deferred;
            ++deferred_maps_[lamp];
            continue;
        }
        any = true;
        budget -= std::min(budget, cost);
        deferred_maps_.erase(lamp);
        maps_to_draw_.push_back(lamp);
    }
}

// The tiles in which lamps see moving placements that they light.
ShadowMaps::Tiles ShadowMaps::dynamic_tiles(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses,
                                            const gpu_scene::View& view) const {
    Tiles wanted;
    if (moving_.moving().empty()) return wanted;
    std::vector<double> light(list.placed());  // lx
    std::vector<MapFrame> frames;
    for (uint32_t i = 0; i < list.placed(); ++i) frames.push_back(map_frame(poses.world[lamps_[list.indices[i]].node]));
    for (const MovingPlacements::Moving& body : moving_.moving()) {
        const glm::dvec3 in_view(view.world_to_view * glm::dvec4(body.centre, 1));
        double sum = 0;
        for (uint32_t i = 0; i < list.placed(); ++i) {
            const glm::dvec3 to = in_view - glm::dvec3(list.lamps[i].position);
            const double away = glm::length(to), nearest = std::max(away - body.radius, 0.1 * body.radius);
            const bool own = std::ranges::binary_search(fixtures_[list.indices[i]], body.placement);
            const bool reached = !own && !is_whole(list.indices[i]) && atlas_[list.indices[i]].side > 0 &&
                                 away - body.radius < double(atlas_[list.indices[i]].range);
            const double candela = reached ? intensity_towards(list, i, to, body.radius) : 0;
            light[i] = candela / std::max(nearest * nearest, 1e-6);
            sum += candela / std::max(away * away, body.radius * body.radius);
        }
        const double size = body.radius / std::max(glm::length(in_view), body.radius);
        for (uint32_t i = 0; i < list.placed(); ++i) {
            if (!(light[i] > kLeastShare * sum) || !(light[i] > kFaintestLight)) continue;
            const uint32_t lamp = list.indices[i];
            glm::dvec3 c = frames[i].rotation * (body.centre - frames[i].position);
            for (uint32_t h = 0; h < atlas_[lamp].hemispheres; ++h, c.z = -c.z)
                for (const glm::uvec2 corner : tiles_of(atlas_[lamp], c, body.radius)) {
                    DynamicTile& tile = wanted[{lamp, h == 1, corner.x, corner.y}];
                    tile.placements.emplace_back(body.placement, body.version);
                    tile.priority += light[i] * size * size;
                }
        }
    }
    return wanted;
}

// Tiles that have changed, those first that give the picture most. A tile that is not reached stays as it is.
void ShadowMaps::plan_tiles(Tiles wanted, const gpu_scene::LampList& list, uint64_t& budget) {
    std::vector<bool> shines(lamps_.size());
    for (uint32_t i = 0; i < list.placed(); ++i) shines[list.indices[i]] = true;
    for (const auto& [id, tile] : tiles_)
        if (shines[id.lamp]) wanted.try_emplace(id, DynamicTile{{}, tile.priority, 0});  // nothing is there any more
    std::vector<std::pair<TileId, DynamicTile>> changed;
    std::map<TileId, uint32_t> deferred;
    for (auto& [id, tile] : wanted) {
        const auto known = tiles_.find(id);
        tile.save = known == tiles_.end();
        if (!tile.save && known->second.placements == tile.placements) continue;
        if (!tile.save) tile.saved = known->second.saved;
        const auto before = deferred_tiles_.find(id);
        if (before != deferred_tiles_.end()) tile.priority *= 1 + before->second;
        changed.emplace_back(id, std::move(tile));
    }
    std::ranges::stable_sort(changed, std::greater(), [](const auto& tile) { return tile.second.priority; });
    tiles_to_draw_.clear();
    std::set<uint32_t> too_many;  // lamps
    for (auto& [id, tile] : changed) {
        if (budget == 0) {
            ++report_.deferred;
            const auto before = deferred_tiles_.find(id);
            deferred[id] = before == deferred_tiles_.end() ? 1 : 1 + before->second;
            continue;
        }
        const std::optional<uint32_t> saved = tile.save ? atlas_.allocate() : std::optional(tile.saved);
        if (!saved) {
            too_many.insert(id.lamp);
            continue;
        }
        --budget;
        tile.saved = *saved;
        tiles_[id] = tile;
        tiles_to_draw_.emplace_back(id, std::move(tile));
    }
    deferred_tiles_ = std::move(deferred);
    // A lamp whose tiles cannot all be saved is drawn as a whole from now on.
    for (const uint32_t lamp : too_many) {
        std::erase_if(tiles_to_draw_, [&](const auto& tile) { return tile.first.lamp == lamp; });
        release_tiles(lamp);
        maps_[lamp].whole = true;
        if (std::ranges::find(maps_to_draw_, lamp) == maps_to_draw_.end()) maps_to_draw_.push_back(lamp);
    }
}

ShadowMapToDraw ShadowMaps::map_of(uint32_t lamp, const gpu_scene::SceneFrame& poses) const {
    return {atlas_[lamp],
            map_frame(poses.world[lamps_[lamp].node]),
            fixtures_[lamp],
            is_whole(lamp) ? std::span<const uint32_t>(everything_) : moving_.still(),
            {},
            {},
            is_whole(lamp) ? caster_error_ : 0,
            lamp};
}

// Those of a map that is drawn as a whole.
IsCaster ShadowMaps::casters_of(uint32_t lamp, const Declared& to) const {
    const auto number = uint32_t(std::ranges::find(to.list.indices, lamp) - to.list.indices.begin());
    const glm::dvec3 position(to.poses.world[lamps_[lamp].node][3]);
    return select_casters({number, position, atlas_[lamp], moves(lamp) ? kFaintestMoving : 0}, to.list, view_, culls());
}

// Takes maps that the cache has out of those to be drawn.
void ShadowMaps::find_cached(const gpu_scene::SceneFrame& poses) {
    cached_ = {};
    if (!cache_ || maps_to_draw_.empty()) return;
    if (!surroundings_) surroundings_ = shadow_surroundings(device_, resident_, moving_.still(), poses);
    const auto is_cached = [&](uint32_t lamp) {
        return !is_whole(lamp) &&
               cached_.find(*cache_, shadow_map_key(*surroundings_, map_of(lamp, poses)), atlas_[lamp]);
    };
    std::vector<uint32_t> missing;
    for (const uint32_t lamp : maps_to_draw_) {
        if (!is_cached(lamp)) {
            missing.push_back(lamp);
            continue;
        }
        maps_[lamp] = {.drawn = true, .whole = maps_[lamp].whole, .culled = false, .version = moving_.version()};
        ++report_.cached;
    }
    maps_to_draw_ = std::move(missing);
}

// By way of another buffer, so that no map is overwritten before it has moved.
void ShadowMaps::declare_moves(const Declared& to) {
    if (moves_.empty()) return;
    std::vector<graph::Region> out, in;
    uint64_t at = 0;
    for (const graph::Region& move : moves_) {
        out.push_back({move.from, at, move.bytes});
        in.push_back({at, move.to, move.bytes});
        at += move.bytes;
    }
    moves_.clear();
    graph::FrameGraph& graph = to.frame.graph;
    const graph::Resource between = graph.transient("moved shadow maps", graph::buffer_shape(at));
    graph.copy("move shadow maps out", to.distances, between, std::move(out));
    graph.copy("move shadow maps in", between, to.distances, std::move(in));
}

void ShadowMaps::declare_maps(Declared& to) {
    cached_.upload(to.frame.graph, to.distances);
    std::vector<ShadowMapToDraw> maps;
    for (const uint32_t lamp : maps_to_draw_) {
        const bool whole = is_whole(lamp);
        ShadowMapToDraw& map = maps.emplace_back(map_of(lamp, to.poses));
        if (whole) map.is_caster = casters_of(lamp, to);
        maps_[lamp] = {
            .drawn = true, .whole = maps_[lamp].whole, .culled = whole && culls(), .version = moving_.version()};
    }
    std::vector<bool> standing;
    if (!maps.empty()) standing = standing_cells(resident_, moving_.still(), to.poses);
    add_shadow_maps(to.frame, resident_, to.poses, standing, maps, to.distances, to.scratch);
    cached_.read_back(to.frame.graph, to.distances);
    maps_to_draw_.clear();
}

void ShadowMaps::declare_tiles(Declared& to) {
    std::vector<ShadowMapToDraw> tiles;
    std::vector<std::vector<uint32_t>> placements;
    placements.reserve(tiles_to_draw_.size());
    for (const auto& [id, tile] : tiles_to_draw_) {
        std::vector<uint32_t>& of_tile = placements.emplace_back();
        for (const auto& [placement, version] : tile.placements) of_tile.push_back(placement);
        ShadowMapToDraw map = map_of(id.lamp, to.poses);
        map.placements = of_tile;
        map.tile = MapTile{id.second, {id.x, id.y}, tile.saved, tile.save};
        tiles.push_back(std::move(map));
    }
    add_shadow_maps(to.frame, resident_, to.poses, {}, tiles, to.distances, to.scratch);
    for (const auto& [id, tile] : tiles_to_draw_)
        if (tile.placements.empty()) {
            atlas_.release(tile.saved);
            tiles_.erase(id);
        }
    tiles_to_draw_.clear();
}

FrameShadowMaps ShadowMaps::declare(const FrameContext& frame, const gpu_scene::LampList& list,
                                    const gpu_scene::SceneFrame& poses) {
    const graph::Resource distances =
        frame.graph.persistent("distances", distances_, atlas_.texels() * sizeof(uint16_t), VK_FORMAT_R16_SFLOAT);
    Declared to{frame, list, poses, distances, add_shadow_map_scratch(frame, resident_)};
    declare_moves(to);
    declare_maps(to);
    declare_tiles(to);
    if (list.placed() == 0) return {};
    std::vector<shared::ShadowMap> lamps;
    for (uint32_t i = 0; i < list.placed(); ++i)
        lamps.push_back(
            shadow_map(atlas_[list.indices[i]], map_frame(poses.world[lamps_[list.indices[i]].node]), view_));
    return {frame.graph.upload("shadow maps", lamps, VK_FORMAT_R32G32B32A32_SFLOAT), distances};
}

void ShadowMaps::forget() {
    for (uint32_t lamp = 0; lamp < lamps_.size(); ++lamp) release_tiles(lamp), maps_[lamp].drawn = false;
    cached_ = {};
    moves_.clear(), maps_to_draw_.clear(), tiles_to_draw_.clear();
}

std::string ShadowMaps::keep(const ShadowCache& drawn, const graph::Executor& executor) const {
    return cache_ ? drawn.store(*cache_, executor) : std::string();
}

}  // namespace vesper::render
