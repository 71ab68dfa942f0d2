// Shadow maps of a scene's lamps, from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/cache.h"
#include "render/light_settings.h"
#include "render/shadows/casting_lamps.h"
#include "render/shadows/draw_shadow_maps.h"
#include "render/shadows/moving_placements.h"
#include "render/shadows/shadow_atlas.h"
#include "render/shadows/shadow_cache.h"
#include "render/shadows/shadow_map_layout.h"
#include "render/shadows/shadow_report.h"
#include "render/shadows/visibility.h"

namespace vesper::render {

/// Settings that sides of maps follow from, beside scene and view.
struct ShadowMapSizes {
    double resolution;  ///< a factor
    uint32_t memory;    ///< MiB: of ShadowReport::bytes, at most
    bool operator==(const ShadowMapSizes&) const = default;
};
inline ShadowMapSizes map_sizes(const LightSettings& settings) {
    return {settings.shadow_resolution, settings.shadow_memory};
}

/// Owns the maps on the device: finds on the host which are out of date, and declares passes that bring them up to date
/// in the graph of a frame. A map holds what stands still around its lamp, drawn when its lamp moves or the view wants
/// another size; and over it what moves, drawn in each frame: a placement whose node is animated, said to move by a
/// frame, or was seen to have moved. A placement does not hide lamps that give less than 1/100 of the light at it while
/// it moves. The map of a lamp that moves has half the side, and holds what hides the lamp from the view and would get
/// 0.1 lx of it undimmed. Sizes depend on the view; what a view sees of the maps depends on the scene, and on what has
/// moved once. Not thread-safe.
class ShadowMaps {
public:
    /// Refers to all of these but the sizes.
    ShadowMaps(const gpu::Device& device, const gpu_scene::GpuScene& resident,
               const std::vector<gpu_scene::PlacedLamp>& lamps, const ShadowMapPlan& plan,
               const ShadowMapSizes& sizes = map_sizes({}));

    /// Takes maps of lamps that stand still from a cache where it has them, and gives it those that are drawn; null:
    /// draws all. The cache must outlive its use here.
    void use(Cache* cache) { cache_ = cache; }

    /// Finds what is out of date for a frame. Host work only. Throws Error where the maps of all lamps do not fit.
    /// `caster_error`: texels, see ShadowMapToDraw; where it is another one than before, all maps are drawn anew.
    /// `unshadowed_share`: lamps that move cast no shadow where they are the faintest, together that share of the light
    /// of this view (add_casting_lamps); 0: all cast shadows.
    void plan(const gpu_scene::LampList& list, const gpu_scene::SceneFrame& poses, const gpu_scene::View& view,
              double caster_error, float unshadowed_share = 0);
    /// Declares the work that plan() found, with its arguments; declared again, nothing is left to draw. `lists`: of
    /// the frame, where plan() had an unshadowed share. Returns the maps of the lamps of the list.
    FrameShadowMaps declare(const FrameContext& frame, const gpu_scene::LampList& list,
                            const gpu_scene::SceneFrame& poses, const BlockLists* lists = nullptr);
    /// A frame that was declared has failed: all maps are drawn anew.
    void forget();
    /// Gives maps of a finished frame to the cache. Returns why the cache keeps no more, once.
    std::string keep(const ShadowCache& drawn, const graph::Executor& executor) const;

    const ShadowMapSizes& sizes() const { return sizes_; }
    const ShadowReport& report() const { return report_; }            ///< of the last plan()
    ShadowCache take_cached() { return std::exchange(cached_, {}); }  ///< of the last declare()
    uint64_t bytes() const { return arena_.bytes(); }                 ///< of device memory, between frames

private:
    /// The content of a lamp's map.
    struct Map {
        bool drawn = false;     // it holds what stands still
        bool moves = false;     // with its lamp
        bool culled = false;    // of a lamp that moves: it holds casters of one view alone
        bool optional = false;  // likewise: it may hold nothing, where its lamp gave little light of one view
        uint64_t version = 0;   // of what moves, in maps of lamps that move
    };
    /// Whether maps of lamps that move hold the casters of one view alone. Frames at the same poses from other
    /// places are known only after the first: a moment is drawn for one view if the moment before had one.
    enum class ViewCulling {
        Off,      // this moment has several views
        Pending,  // one until now, the moment before had several
        On        // one until now, as the moment before
    };
    /// For lamps that stand still, the placements that move and hide them, and their versions.
    using Bodies = std::map<uint32_t, std::vector<std::pair<uint32_t, uint64_t>>>;

    /// The maps in the graph of a frame.
    struct Declared {
        const FrameContext& frame;
        const gpu_scene::LampList& list;
        const gpu_scene::SceneFrame& poses;
        graph::Resource still, distances;
        ShadowMapScratch scratch;
    };

    void declare_restoring(const Declared& to);
    void declare_moves(const Declared& to);
    void declare_still_maps(const Declared& to);
    void declare_what_moves(const Declared& to);
    void find_cached(const gpu_scene::SceneFrame& poses);
    ShadowMapToDraw map_of(uint32_t lamp, const gpu_scene::SceneFrame& poses) const;
    static uint32_t number_of(uint32_t lamp, const gpu_scene::LampList& list);
    graph::Resource lamps_of(const Declared& to, const BlockLists* lists) const;
    IsCaster casters_of(uint32_t lamp, const Declared& to) const;
    void update_light(const gpu_scene::LampList& list, const gpu_scene::View& view, float unshadowed_share);
    void update_view(const gpu_scene::View& view, const gpu_scene::SceneFrame& poses);
    void forget_still(const std::vector<uint32_t>& placements);
    bool moves(uint32_t lamp) const { return moving_.moves(lamps_[lamp].node); }
    bool is_out_of_date(const Map& map) const {
        if (map.version != moving_.version()) return true;
        return map.optional ? !is_same_light_ : map.culled && culling_ != ViewCulling::On;
    }
    bool may_leave_out() const { return unshadowed_share_ > 0; }
    bool culls() const { return may_leave_out() || culling_ == ViewCulling::On; }
    void plan_maps(const gpu_scene::LampList& list);
    Bodies bodies_in_light(const gpu_scene::LampList& list, const gpu_scene::View& view) const;

    const gpu_scene::GpuScene& resident_;
    const std::vector<gpu_scene::PlacedLamp>& lamps_;
    const std::vector<std::vector<uint32_t>>& fixtures_;
    ShadowMapSizes sizes_;
    ShadowAtlas atlas_;
    MovingPlacements moving_;
    gpu::Arena arena_;
    gpu::OwnedBuffer still_;      // texels of all maps, with what stands still alone
    gpu::OwnedBuffer distances_;  // the same, with what moves
    gpu::OwnedBuffer changed_;    // tiles that differ between the two (shared::ChangedTile)
    bool lists_nothing_ = true;   // `changed_` is to be emptied
    std::vector<Map> maps_;       // of lamps
    gpu_scene::View view_;        // of the last plan()
    ViewCulling culling_ = ViewCulling::Off;
    double caster_error_ = 0;  // texels
    float unshadowed_share_ = 0;
    std::vector<shared::Lamp> lamps_seen_;  // of the last plan()
    bool is_same_light_ = false;            // as in the plan() before: view, lamps and share
    Bodies bodies_, drawn_bodies_;          // wanted, and in the maps
    bool draws_bodies_ = false;             // in this frame
    std::vector<uint32_t> maps_to_draw_;    // lamps
    std::vector<uint32_t> copied_;          // likewise: still maps that are new
    std::vector<graph::Region> moves_;      // of texels, to be made before, bytes
    ShadowReport report_;
    std::optional<CasterGroups> groups_;  // of what stands still
    Cache* cache_ = nullptr;
    ShadowCache cached_;
    std::optional<Digest::Value> surroundings_;  // of maps that hold what stands still, see shadow_surroundings()
    const gpu::Device& device_;
    std::vector<uint32_t> everything_;  // placements
};

}  // namespace vesper::render
