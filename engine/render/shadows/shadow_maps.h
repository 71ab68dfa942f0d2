// Shadow maps of a scene's lamps, from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/cache.h"
#include "render/light_settings.h"
#include "render/shadows/draw_shadow_maps.h"
#include "render/shadows/moving_placements.h"
#include "render/shadows/shadow_atlas.h"
#include "render/shadows/shadow_cache.h"
#include "render/shadows/shadow_map_layout.h"
#include "render/shadows/shadow_report.h"
#include "render/shadows/visibility.h"

namespace vesper::render {

/// Owns the maps on the device: finds on the host which are out of date, and declares passes that bring them up to date
/// in the graph of a frame. A map holds what stands still around its lamp, drawn when its lamp moves or the view wants
/// another size; and over it, tile by tile, what moves: a placement whose node is animated, said to move by a frame, or
/// was seen to have moved. A placement does not hide lamps that give less than 1/100 of the light at it while it moves.
/// The map of a lamp that moves has half the side, and holds what hides the lamp from the view and would get 0.1 lx of
/// it undimmed. Sizes depend on the view; what a view sees of the maps depends on the scene, and on what has moved
/// once. Not thread-safe.
class ShadowMaps {
public:
    /// Refers to all of these. `resolution`: of the sides that the plan chooses, as a factor.
    ShadowMaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
               const std::vector<gpu_scene::PlacedLamp>& lamps, const ShadowMapPlan& plan, double resolution = 1);

    /// Takes maps of lamps that stand still from a cache where it has them, and gives it those that are drawn; null:
    /// draws all. The cache must outlive its use here.
    void use(Cache* cache) { cache_ = cache; }

    /// Finds what is out of date for a frame. `budget`: of tiles of shared::kRegion texels square that are drawn, maps
    /// that hold nothing yet apart; a whole map counts as its tiles, but at least as 128, and a quarter of the budget
    /// is for these alone. What gives the picture most comes first, the rest is counted as deferred. Host work only.
    /// Throws Error where the maps of all lamps do not fit.
    /// `caster_error`: texels, see ShadowMapToDraw; where it is another one than before, all maps are drawn anew.
    void plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
              uint64_t budget, double caster_error);
    /// Declares the work that plan() found, with its arguments; declared again, nothing is left to draw. Returns the
    /// maps of the lamps of the list.
    FrameShadowMaps declare(const FrameContext& frame, const gpu_scene::LampList& list,
                            const gpu_scene::SceneFrame& poses);
    /// A frame that was declared has failed: all maps are drawn anew.
    void forget();
    /// Gives maps of a finished frame to the cache. Returns why the cache keeps no more, once.
    std::string keep(const ShadowCache& drawn, const graph::Executor& executor) const;

    const ShadowReport& report() const { return report_; }            ///< of the last plan()
    ShadowCache take_cached() { return std::exchange(cached_, {}); }  ///< of the last declare()
    uint64_t bytes() const { return arena_.bytes(); }                 ///< of device memory

private:
    /// The content of a lamp's map.
    struct Map {
        bool drawn = false;    // it holds what stands still
        bool whole = false;    // it is drawn as that of a lamp that moves
        bool culled = false;   // it holds casters of one view alone
        uint64_t version = 0;  // of what moves, in maps that are drawn as a whole
    };
    /// Whether maps that are drawn as a whole hold the casters of one view alone. Frames at the same poses from other
    /// places are known only after the first: a moment is drawn for one view if the moment before had one.
    enum class ViewCulling {
        Off,      // this moment has several views
        Pending,  // one until now, the moment before had several
        On        // one until now, as the moment before
    };
    struct TileId {
        uint32_t lamp;
        bool second;    // hemisphere
        uint32_t x, y;  // corner, texels
        auto operator<=>(const TileId&) const = default;
    };
    /// A tile over which moving placements are drawn.
    struct DynamicTile {
        std::vector<std::pair<uint32_t, uint64_t>> placements;  // and their versions
        double priority = 0;
        uint32_t saved = 0;  // first texel of the still content
        bool save = false;   // which is not saved yet
    };
    using Tiles = std::map<TileId, DynamicTile>;

    /// The maps in the graph of a frame.
    struct Declared {
        const FrameContext& frame;
        const gpu_scene::LampList& list;
        const gpu_scene::SceneFrame& poses;
        graph::Resource distances;
        ShadowMapScratch scratch;
    };

    void declare_moves(const Declared& to);
    void declare_maps(Declared& to);
    void declare_tiles(Declared& to);
    void find_cached(const gpu_scene::SceneFrame& poses);
    ShadowMapToDraw map_of(uint32_t lamp, const gpu_scene::SceneFrame& poses) const;
    IsCaster casters_of(uint32_t lamp, const Declared& to) const;
    void update_view(const gpu_scene::View& view, const gpu_scene::SceneFrame& poses);
    void forget_still(const std::vector<uint32_t>& placements);
    bool moves(uint32_t lamp) const { return moving_.moves(lamps_[lamp].node); }
    bool is_whole(uint32_t lamp) const { return maps_[lamp].whole || moves(lamp); }
    bool is_out_of_date(const Map& map) const {
        return map.version != moving_.version() || (map.culled && culling_ != ViewCulling::On);
    }
    bool culls() const { return current_ && culling_ == ViewCulling::On; }
    void release_tiles(uint32_t lamp);
    void plan_new_maps(const gpu_scene::LampList& list, uint64_t& budget);
    void plan_moved_maps(const gpu_scene::LampList& list, uint64_t budget);
    Tiles dynamic_tiles(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses,
                        const gpu_scene::View& view) const;
    void plan_tiles(Tiles wanted, const gpu_scene::LampList& list, uint64_t& budget);

    const gpu_scene::GpuScene& resident_;
    const std::vector<gpu_scene::PlacedLamp>& lamps_;
    const std::vector<std::vector<uint32_t>>& fixtures_;
    ShadowAtlas atlas_;
    MovingPlacements moving_;
    gpu::Arena arena_;
    gpu::OwnedBuffer distances_;
    std::vector<Map> maps_;  // of lamps
    gpu_scene::View view_;   // of the last plan()
    ViewCulling culling_ = ViewCulling::Off;
    double caster_error_ = 0;             // texels
    bool current_ = true;                 // no map is ever out of date
    Tiles tiles_;                         // that hold moving placements
    std::vector<uint32_t> maps_to_draw_;  // lamps
    std::vector<std::pair<TileId, DynamicTile>> tiles_to_draw_;
    std::vector<graph::Region> moves_;           // of texels, to be made before, bytes
    std::map<TileId, uint32_t> deferred_tiles_;  // and for how many frames
    std::map<uint32_t, uint32_t> deferred_maps_;
    ShadowReport report_;
    Cache* cache_ = nullptr;
    ShadowCache cached_;
    std::optional<Digest::Value> surroundings_;  // of maps that hold what stands still, see shadow_surroundings()
    const gpu::Device& device_;
    std::vector<uint32_t> everything_;  // placements
};

}  // namespace vesper::render
