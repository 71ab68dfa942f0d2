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

constexpr double kFaintestMoving = 0.1;  // lx: what a lamp lights less while it moves it may light through something
// visibility.comp: a look is aside by at most so many radii of the lamp, across the way of its light and then along a
// plane on which it is ten times as long; and by so many texels, where the plane of a surface may be twice as far.
constexpr double kAside = 3 * 11, kTexelsAside = 4, kPlaneReach = 2;
constexpr double kLeastShare = 1.0 / 100;  // of the light at a placement: a lamp that gives less is not hidden by it

}  // namespace

ShadowMaps::ShadowMaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
                       const std::vector<gpu_scene::PlacedLamp>& lamps, const ShadowMapPlan& plan)
    : resident_(resident),
      lamps_(lamps),
      fixtures_(plan.fixtures),
      places_(plan.layouts, plan.scale),
      moving_(resident, plan.animated),
      arena_(device),
      drawn_(lamps.size()),
      whole_(lamps.size()),
      drawn_version_(lamps.size()),
      for_view_(lamps.size()),
      device_(device),
      everything_(resident.placements().size()) {
    distances_ = make_shadow_texels(device, arena_, places_.texels());
    std::iota(everything_.begin(), everything_.end(), 0u);
}

void ShadowMaps::plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
                      uint64_t budget) {
    report_ = {};
    maps_to_draw_.clear();
    look_from(view, poses);
    const uint64_t most_texels = budget == kNoShadowBudget ? budget : budget / 2 * ShadowAtlas::kTileTexels;
    std::vector<bool> moves;
    for (const gpu_scene::PlacedLamp& lamp : lamps_) moves.push_back(moving_.moves(lamp.node));
    ShadowAtlas::Change change = places_.fit(list, most_texels, moves);
    moves_ = std::move(change.moves);
    for (const uint32_t lamp : change.lamps) {
        drop_tiles(lamp);
        drawn_[lamp] = whole_[lamp] = false;
    }
    plan_new_maps(list, budget);
    // A quarter is for maps alone, so that they are reached.
    uint64_t for_tiles = budget - budget / 4;
    budget -= for_tiles;
    plan_tiles(covers(list, poses, view), list, for_tiles);
    const bool budgeted = most_texels != kNoShadowBudget;
    plan_moved_maps(list, budget + for_tiles, budgeted);
    current_ = !budgeted;
    find_kept(poses);
    report_.maps = uint32_t(maps_to_draw_.size());
    report_.tiles = uint32_t(tiles_to_draw_.size());
    report_.bytes = arena_.bytes();
}

// Takes poses and a view. Frames at the same poses from different places are known only after the first, so what they
// show of a moment is drawn for one view alone where there was one of the moment before.
void ShadowMaps::look_from(const gpu_scene::View& view, const gpu_scene::SceneFrame& poses) {
    const uint64_t version = moving_.version();
    forget_still(moving_.update(poses));
    if (moving_.version() != version) {
        one_view_ = !more_views_, more_views_ = false;
    } else if (view.world_to_view != view_.world_to_view || view.tangent_low != view_.tangent_low ||
               view.tangent_high != view_.tangent_high) {
        one_view_ = false, more_views_ = true;
    }
    view_ = view;
}

// Maps that may hold placements which have begun to move hold them no more.
void ShadowMaps::forget_still(const std::vector<uint32_t>& placements) {
    if (placements.empty()) return;
    drawn_.assign(drawn_.size(), false);
    surroundings_.reset();
}

void ShadowMaps::drop_tiles(uint32_t lamp) {
    const auto first = covered_.lower_bound({lamp, false, 0, 0}), end = covered_.lower_bound({lamp + 1, false, 0, 0});
    for (auto at = first; at != end; ++at) places_.release(at->second.saved);
    covered_.erase(first, end);
}

// Maps that hold nothing yet.
void ShadowMaps::plan_new_maps(const gpu_scene::LampList& list, uint64_t& budget) {
    for (uint32_t i = 0; i < list.placed(); ++i) {
        const uint32_t lamp = list.indices[i];
        if (places_[lamp].side == 0) continue;
        ++report_.lamps;
        if (is_whole(lamp)) drop_tiles(lamp);
        if (drawn_[lamp]) continue;
        maps_to_draw_.push_back(lamp);
        budget -= std::min(budget, cost_of(places_[lamp]));
        drop_tiles(lamp);
    }
}

// Of lamps whose maps are drawn as a whole, frame by frame. `current`: no map is ever out of date, and so none is
// looked at from elsewhere.
void ShadowMaps::select_casters(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, bool current) {
    matters_.assign(lamps_.size(), {});
    drawn_for_view_ = current && one_view_;
    const glm::dmat3 to_view(view_.world_to_view);
    for (uint32_t i = 0; i < list.placed(); ++i) {
        const uint32_t lamp = list.indices[i];
        if (!is_whole(lamp) || std::ranges::find(maps_to_draw_, lamp) == maps_to_draw_.end()) continue;
        const ShadowMapLayout& layout = places_[lamp];
        const glm::dvec3 position(poses.world[lamps_[lamp].node][3]);
        std::vector<HalfSpace> paths;
        if (drawn_for_view_) paths = light_paths(view_, position, kPlaneReach);
        const double beside = kAside * double(layout.radius);
        const double texels = kTexelsAside * 2 / (double(layout.side) * double(layout.zoom));
        // Of the lamp as it shines undimmed, so that its map serves when it is dimmed otherwise.
        const double undimmed = kFaintestLight * double(layout.range) * double(layout.range);
        const double share = undimmed / double(list.lamps[i].intensity);
        const double least = moving_.moves(lamps_[lamp].node) ? kFaintestMoving : 0;
        matters_[lamp] = [=, &list](const gpu_scene::WorldSphere& sphere) {
            const glm::dvec3 to = sphere.centre - position;
            const double away = glm::length(to), nearest = std::max(away - sphere.radius, 0.0);
            const double radius = sphere.radius + beside + texels * away;
            return may_lie_in(paths, {sphere.centre, radius}) &&
                   share * intensity_towards(list, i, to_view * to, radius) >= least * nearest * nearest;
        };
    }
}

// Of maps of lamps that move, those first whose light is nearest to the eye.
void ShadowMaps::plan_moved_maps(const gpu_scene::LampList& list, uint64_t budget, bool budgeted) {
    std::vector<std::pair<double, uint32_t>> moved;
    for (uint32_t i = 0; i < list.placed(); ++i) {
        const uint32_t lamp = list.indices[i];
        if (places_[lamp].side > 0 && drawn_[lamp] && is_whole(lamp) && is_out_of_date(lamp) &&
            std::ranges::find(maps_to_draw_, lamp) == maps_to_draw_.end()) {
            const double away = double(glm::length(list.lamps[i].position));
            const double worth = double(list.lamps[i].intensity) / std::max(away * away, 1.0);
            const auto waits = waiting_maps_.find(lamp);
            moved.emplace_back(-worth * (waits == waiting_maps_.end() ? 1 : 1 + waits->second), lamp);
        }
    }
    std::ranges::sort(moved);
    bool any = false;  // one is drawn in any case, so that none waits for ever
    for (const auto& [worth, lamp] : moved) {
        const uint64_t cost = cost_of(places_[lamp]);
        const bool elsewhere = for_view_[lamp] && budgeted;  // what hides it from this view may not be there at all
        if (cost > budget && (any || budget == 0) && !elsewhere) {
            ++report_.deferred;
            ++waiting_maps_[lamp];
            continue;
        }
        any = true;
        budget -= std::min(budget, cost);
        waiting_maps_.erase(lamp);
        maps_to_draw_.push_back(lamp);
    }
}

// What moves where lamps shine on it, tile by tile.
std::map<ShadowMaps::TileKey, ShadowMaps::Cover> ShadowMaps::covers(const gpu_scene::LampList& list,
                                                                    const gpu_scene::SceneFrame& poses,
                                                                    const gpu_scene::View& view) const {
    std::map<TileKey, Cover> wanted;
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
            const bool reached = !own && !is_whole(list.indices[i]) && places_[list.indices[i]].side > 0 &&
                                 away - body.radius < double(places_[list.indices[i]].range);
            const double candela = reached ? intensity_towards(list, i, to, body.radius) : 0;
            light[i] = candela / std::max(nearest * nearest, 1e-6);
            sum += candela / std::max(away * away, body.radius * body.radius);
        }
        const double size = body.radius / std::max(glm::length(in_view), body.radius);
        for (uint32_t i = 0; i < list.placed(); ++i) {
            if (!(light[i] > kLeastShare * sum) || !(light[i] > kFaintestLight)) continue;
            const uint32_t lamp = list.indices[i];
            glm::dvec3 c = frames[i].rotation * (body.centre - frames[i].position);
            for (uint32_t h = 0; h < places_[lamp].hemispheres; ++h, c.z = -c.z)
                for (const glm::uvec2 corner : tiles_of(places_[lamp], c, body.radius)) {
                    Cover& cover = wanted[{lamp, h == 1, corner.x, corner.y}];
                    cover.placements.emplace_back(body.placement, body.version);
                    cover.worth += light[i] * size * size;
                }
        }
    }
    return wanted;
}

// Tiles that have changed, those first that give the picture most. A tile that is not reached stays as it is.
void ShadowMaps::plan_tiles(std::map<TileKey, Cover> wanted, const gpu_scene::LampList& list, uint64_t& budget) {
    std::vector<bool> shines(lamps_.size());
    for (uint32_t i = 0; i < list.placed(); ++i) shines[list.indices[i]] = true;
    for (const auto& [key, cover] : covered_)
        if (shines[key.lamp]) wanted.try_emplace(key, Cover{{}, cover.worth, 0});  // nothing is there any more
    std::vector<TileToDraw> changed;
    std::map<TileKey, uint32_t> waiting;
    for (auto& [key, cover] : wanted) {
        const auto known = covered_.find(key);
        const bool save = known == covered_.end();
        if (!save && known->second.placements == cover.placements) continue;
        if (!save) cover.saved = known->second.saved;
        const auto waits = waiting_.find(key);
        if (waits != waiting_.end()) cover.worth *= 1 + waits->second;
        changed.push_back({key, std::move(cover), save});
    }
    std::ranges::stable_sort(changed, std::greater(), [](const TileToDraw& tile) { return tile.cover.worth; });
    tiles_to_draw_.clear();
    std::set<uint32_t> too_many;  // lamps
    for (TileToDraw& tile : changed) {
        if (budget == 0) {
            ++report_.deferred;
            const auto waits = waiting_.find(tile.key);
            waiting[tile.key] = waits == waiting_.end() ? 1 : 1 + waits->second;
            continue;
        }
        const std::optional<uint32_t> saved = tile.save ? places_.allocate() : std::optional(tile.cover.saved);
        if (!saved) {
            too_many.insert(tile.key.lamp);
            continue;
        }
        --budget;
        tile.cover.saved = *saved;
        covered_[tile.key] = tile.cover;
        tiles_to_draw_.push_back(std::move(tile));
    }
    waiting_ = std::move(waiting);
    // A lamp whose tiles cannot all be saved is drawn as a whole from now on.
    for (const uint32_t lamp : too_many) {
        std::erase_if(tiles_to_draw_, [&](const TileToDraw& tile) { return tile.key.lamp == lamp; });
        drop_tiles(lamp);
        whole_[lamp] = true;
        if (std::ranges::find(maps_to_draw_, lamp) == maps_to_draw_.end()) maps_to_draw_.push_back(lamp);
    }
}

ShadowMapToDraw ShadowMaps::map_of(uint32_t lamp, const gpu_scene::SceneFrame& poses) const {
    return {places_[lamp],
            map_frame(poses.world[lamps_[lamp].node]),
            fixtures_[lamp],
            is_whole(lamp) ? std::span<const uint32_t>(everything_) : moving_.still(),
            matters_.empty() ? nullptr : matters_[lamp],
            {},
            lamp};
}

// Takes maps out of those to be drawn.
void ShadowMaps::find_kept(const gpu_scene::SceneFrame& poses) {
    kept_ = {};
    if (!cache_ || maps_to_draw_.empty()) return;
    if (!surroundings_) surroundings_ = shadow_surroundings(device_, resident_, moving_.still(), poses);
    matters_.clear();
    const auto is_kept = [&](uint32_t lamp) {
        return !is_whole(lamp) &&
               kept_.find(*cache_, shadow_map_key(*surroundings_, map_of(lamp, poses)), places_[lamp]);
    };
    std::vector<uint32_t> missing;
    for (const uint32_t lamp : maps_to_draw_) {
        if (!is_kept(lamp)) {
            missing.push_back(lamp);
            continue;
        }
        drawn_[lamp] = true, drawn_version_[lamp] = moving_.version(), for_view_[lamp] = false;
        ++report_.cached;
    }
    maps_to_draw_ = std::move(missing);
}

// By way of another buffer, so that no map is overwritten before it has moved.
void ShadowMaps::declare_moves(const Declared& to) {
    if (moves_.empty()) return;
    constexpr uint64_t kTexel = sizeof(uint16_t);
    std::vector<graph::Region> out, in;
    uint64_t at = 0;
    for (const ShadowAtlas::Move& move : moves_) {
        out.push_back({kTexel * move.from, at, kTexel * move.texels});
        in.push_back({at, kTexel * move.to, kTexel * move.texels});
        at += kTexel * move.texels;
    }
    moves_.clear();
    graph::FrameGraph& graph = to.frame.graph;
    const graph::Resource between = graph.transient("maps that move", graph::buffer_shape(at));
    graph.copy("take maps away", to.distances, between, std::move(out));
    graph.copy("put maps elsewhere", between, to.distances, std::move(in));
}

void ShadowMaps::declare_maps(Declared& to) {
    kept_.bring(to.frame.graph, to.distances);
    std::vector<ShadowMapToDraw> maps;
    for (const uint32_t lamp : maps_to_draw_) {
        maps.push_back(map_of(lamp, to.poses));
        drawn_[lamp] = true, drawn_version_[lamp] = moving_.version();
        for_view_[lamp] = drawn_for_view_ && is_whole(lamp);
    }
    add_shadow_maps(to.frame, resident_, to.poses, maps, to.distances, to.scratch);
    kept_.fetch(to.frame.graph, to.distances);
    maps_to_draw_.clear();
}

void ShadowMaps::declare_tiles(Declared& to) {
    std::vector<ShadowMapToDraw> tiles;
    std::vector<std::vector<uint32_t>> placements;
    placements.reserve(tiles_to_draw_.size());
    for (const TileToDraw& tile : tiles_to_draw_) {
        std::vector<uint32_t>& of_tile = placements.emplace_back();
        for (const auto& [placement, version] : tile.cover.placements) of_tile.push_back(placement);
        ShadowMapToDraw map = map_of(tile.key.lamp, to.poses);
        map.placements = of_tile, map.matters = {};
        map.tile = MapTile{tile.key.second, {tile.key.x, tile.key.y}, tile.cover.saved, tile.save};
        tiles.push_back(std::move(map));
    }
    add_shadow_maps(to.frame, resident_, to.poses, tiles, to.distances, to.scratch);
    for (const TileToDraw& tile : tiles_to_draw_)
        if (tile.cover.placements.empty()) {
            places_.release(tile.cover.saved);
            covered_.erase(tile.key);
        }
    tiles_to_draw_.clear();
}

FrameShadowMaps ShadowMaps::declare(const FrameContext& frame, const gpu_scene::LampList& list,
                                    const gpu_scene::SceneFrame& poses) {
    const graph::Resource distances =
        frame.graph.persistent("distances", distances_, places_.texels() * sizeof(uint16_t), VK_FORMAT_R16_SFLOAT);
    Declared to{frame, poses, distances, add_shadow_map_scratch(frame, resident_)};
    select_casters(list, poses, current_);
    declare_moves(to);
    declare_maps(to);
    declare_tiles(to);
    matters_.clear();
    if (list.placed() == 0) return {};
    std::vector<shared::ShadowMap> lamps;
    for (uint32_t i = 0; i < list.placed(); ++i)
        lamps.push_back(
            shadow_map(places_[list.indices[i]], map_frame(poses.world[lamps_[list.indices[i]].node]), view_));
    return {frame.graph.upload("lamp maps", lamps, VK_FORMAT_R32G32B32A32_SFLOAT), distances};
}

void ShadowMaps::forget() {
    for (uint32_t lamp = 0; lamp < lamps_.size(); ++lamp) drop_tiles(lamp);
    drawn_.assign(drawn_.size(), false);
    kept_ = {};
    moves_.clear(), maps_to_draw_.clear(), tiles_to_draw_.clear();
}

std::string ShadowMaps::keep(const ShadowCache& kept, const graph::Executor& executor) const {
    return cache_ ? kept.keep(*cache_, executor) : std::string();
}

}  // namespace vesper::render
