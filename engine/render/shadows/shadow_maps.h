// Shadow maps of a scene's lamps, kept from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/cache.h"
#include "render/shadows/draw_shadow_maps.h"
#include "render/shadows/moving_placements.h"
#include "render/shadows/shadow_atlas.h"
#include "render/shadows/shadow_cache.h"
#include "render/shadows/shadow_map_layout.h"
#include "render/shadows/shadow_report.h"
#include "render/shadows/visibility.h"

namespace vesper::render {

/// Owns the maps on the device: finds on the host which are out of date, and declares what brings them up to date in
/// the graph of a frame. A map holds what stands still around its lamp, drawn when its lamp moves or the view wants
/// another size; and over it, tile by tile, what moves: a placement whose node is animated, said to move by a frame, or
/// was seen to have moved. A placement does not hide lamps that give less than 1/100 of the light at it while it moves.
/// The map of a lamp that moves has half the side, and holds what hides the lamp from the view and would get 0.1 lx of
/// it undimmed. Sizes depend on the view; what a view sees of the maps depends on the scene, and on what has moved
/// once. Not thread-safe.
class ShadowMaps {
public:
    ShadowMaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
               const std::vector<gpu_scene::PlacedLamp>& lamps, const ShadowMapPlan& plan);

    /// Takes maps of lamps that stand still from a cache where it has them, and gives it those that are drawn; null:
    /// draws all. The cache must outlive its use here.
    void use(Cache* cache) { cache_ = cache; }

    /// Finds what is out of date for a frame. `budget`: of tiles of shared::kRegion texels square that are drawn, maps
    /// that hold nothing yet apart; a whole map counts as its tiles, but at least as 128, and a quarter of the budget
    /// is for these alone. What gives the picture most comes first, the rest is counted as carried. Host work only.
    /// Throws Error where the maps of all lamps do not fit.
    void plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
              uint64_t budget);
    /// Declares what plan() found, with its arguments; declared again, nothing is left to draw. Returns the maps of the
    /// lamps of the list.
    FrameShadowMaps declare(const FrameContext& frame, const gpu_scene::LampList& list,
                            const gpu_scene::SceneFrame& poses);
    /// A frame that was declared has failed: all maps are drawn anew.
    void forget();
    /// Gives maps of a finished frame to the cache. Returns why the cache keeps no more, once.
    std::string keep(const ShadowCache& kept, const graph::Executor& executor) const;

    const ShadowReport& report() const { return report_; }          ///< of the last plan()
    ShadowCache take_cached() { return std::exchange(kept_, {}); }  ///< of the last declare()
    uint64_t bytes() const { return arena_.bytes(); }               ///< of device memory

private:
    struct TileKey {
        uint32_t lamp;
        bool second;    // hemisphere
        uint32_t x, y;  // corner, texels
        auto operator<=>(const TileKey&) const = default;
    };
    /// What is drawn over a tile.
    struct Cover {
        std::vector<std::pair<uint32_t, uint64_t>> placements;  // and their versions
        double worth = 0;
        uint32_t saved = 0;  // first texel of what it hides
    };
    struct TileToDraw {
        TileKey key;
        Cover cover;
        bool save;
    };

    /// The maps in the graph of a frame.
    struct Declared {
        const FrameContext& frame;
        const gpu_scene::SceneFrame& poses;
        graph::Resource distances;
        ShadowMapScratch scratch;
    };

    void declare_moves(const Declared& to);
    void declare_maps(Declared& to);
    void declare_tiles(Declared& to);
    void find_kept(const gpu_scene::SceneFrame& poses);
    ShadowMapToDraw map_of(uint32_t lamp, const gpu_scene::SceneFrame& poses) const;
    void look_from(const gpu_scene::View& view, const gpu_scene::SceneFrame& poses);
    void select_casters(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, bool current);
    void forget_still(const std::vector<uint32_t>& placements);
    bool is_whole(uint32_t lamp) const { return whole_[lamp] || moving_.moves(lamps_[lamp].node); }
    bool is_out_of_date(uint32_t lamp) const {
        return drawn_version_[lamp] != moving_.version() || (for_view_[lamp] && !one_view_);
    }
    void drop_tiles(uint32_t lamp);
    void plan_new_maps(const gpu_scene::LampList& list, uint64_t& budget);
    void plan_moved_maps(const gpu_scene::LampList& list, uint64_t budget, bool budgeted);
    std::map<TileKey, Cover> covers(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses,
                                    const gpu_scene::View& view) const;
    void plan_tiles(std::map<TileKey, Cover> wanted, const gpu_scene::LampList& list, uint64_t& budget);

    const gpu_scene::GpuScene& resident_;
    const std::vector<gpu_scene::PlacedLamp>& lamps_;
    const std::vector<std::vector<uint32_t>>& fixtures_;
    ShadowAtlas places_;
    MovingPlacements moving_;
    gpu::Arena arena_;
    gpu::OwnedBuffer distances_;
    std::vector<bool> drawn_;              // of lamps: the map holds what stands still
    std::vector<bool> whole_;              // of lamps: the map is drawn as that of one that moves
    std::vector<uint64_t> drawn_version_;  // of what moves, in maps of lamps that move
    std::vector<bool> for_view_;           // of lamps: the map holds what hides it from the view alone
    gpu_scene::View view_;                 // of the last plan()
    bool drawn_for_view_ = false;          // what is to be drawn
    bool one_view_ = false;                // what is drawn is for this one alone
    bool more_views_ = true;               // of the same moment
    bool current_ = true;                  // no map is ever out of date
    std::vector<std::function<bool(const gpu_scene::WorldSphere&)>> matters_;  // of lamps, see ShadowMapToDraw
    std::map<TileKey, Cover> covered_;                                         // tiles that hold more
    std::vector<uint32_t> maps_to_draw_;                                       // lamps
    std::vector<TileToDraw> tiles_to_draw_;
    std::vector<ShadowAtlas::Move> moves_;  // to be made before
    std::map<TileKey, uint32_t> waiting_;   // frames for which tiles have been carried over
    std::map<uint32_t, uint32_t> waiting_maps_;
    ShadowReport report_;
    Cache* cache_ = nullptr;
    ShadowCache kept_;
    std::optional<Digest::Value> surroundings_;  // of maps that hold what stands still, see shadow_surroundings()
    const gpu::Device& device_;
    std::vector<uint32_t> everything_;  // placements
};

}  // namespace vesper::render
