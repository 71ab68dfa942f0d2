// Shadow maps of lamps, drawn. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/digest.h"
#include "render/frame_context.h"
#include "render/shadows/caster_parts.h"
#include "render/shadows/casters.h"
#include "render/shadows/shadow_map_layout.h"

namespace vesper::render {

/// One tile of a hemisphere of a map: shared::kRegion texels square.
struct MapTile {
    bool second = false;   ///< hemisphere
    glm::uvec2 corner{0};  ///< texels
    uint32_t saved = 0;    ///< first of the texels without what is drawn, of all maps; a multiple of kMapUnit
    bool save = false;     ///< they are to be saved there first
};

/// The map of a lamp that is to be drawn.
struct ShadowMapToDraw {
    ShadowMapLayout layout;
    MapFrame frame;
    std::span<const uint32_t> fixture;     ///< placements that do not hide the lamp, ascending
    std::span<const uint32_t> placements;  ///< what else is drawn
    IsCaster is_caster{};                  ///< of these; empty: all
    std::optional<MapTile> tile{};         ///< into this tile, over what it saved; without: into an empty map
    /// Texels that cells of casters at rest may be off in place of their parts; without a tile. 0: parts are drawn.
    double caster_error = 0;
    /// Number of the lamp. Chooses where in an image it is drawn: coordinates are rounded there, so that texels depend
    /// on it by a bit, and on nothing else that is drawn.
    uint32_t lamp = 0;
};

/// The cells of a scene that stand as they were made at these poses, of placements `still`, ascending; per cell.
std::vector<bool> standing_cells(const gpu_scene::GpuScene& scene, std::span<const uint32_t> still,
                                 const gpu_scene::SceneFrame& poses);

/// Draws placements around lamps, at the poses of `poses`, into their maps: texels of `distances`, r32ui, two halves a
/// word (shared/shadow_map.h). Surfaces hide a lamp from both sides; masked ones where they are drawn, clear ones not
/// at all. Parts smaller than half a texel, and what is farther than the range of a map, are left out. Distances are
/// rounded to halves, 0.1 %. Cells that are `standing` take the place of their parts.
/// Images are drawn one after the other in `scratch`.
void add_shadow_maps(const FrameContext& frame, const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses,
                     const std::vector<bool>& standing, std::span<const ShadowMapToDraw> maps,
                     graph::Resource distances, ShadowMapScratch& scratch);

/// The shaders that draw them.
void add_shadow_map_shaders(Digest& digest);

}  // namespace vesper::render
