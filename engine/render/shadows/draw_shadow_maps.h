// Shadow maps of lamps, drawn. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "base/digest.h"
#include "render/frame_context.h"
#include "render/shadows/caster_groups.h"
#include "render/shadows/caster_parts.h"
#include "render/shadows/casters.h"
#include "render/shadows/shadow_map_layout.h"

namespace vesper::render {

/// The map of a lamp that is to be drawn.
struct ShadowMapToDraw {
    ShadowMapLayout layout;
    MapFrame frame;
    std::span<const uint32_t> fixture;     ///< placements that do not hide the lamp, ascending
    std::span<const uint32_t> placements;  ///< what else is drawn
    IsCaster is_caster{};                  ///< of what is drawn
    /// Texels that cells of casters at rest may be off in place of their parts. 0: groups are not drawn.
    double caster_error = 0;
    /// In the list of the frame: opaque parts are drawn if it has a map in ShadowMapScratch::lamps. Or in any case.
    uint32_t number = shared::kCastsAlways;
};

/// Draws placements around lamps, at the poses of `poses`, into empty maps: texels of `distances`, r32ui, two halves a
/// word (shared/shadow_map.h). Surfaces hide a lamp from both sides; masked ones where they are drawn, clear ones not
/// at all. Parts smaller than half a texel, and what is farther than the range of a map, are left out. Distances are
/// rounded to halves, 0.1 %. `groups`, or null, are drawn into maps with a caster error. A map has the same bits
/// whatever else is drawn.
void add_shadow_maps(const FrameContext& frame, const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses,
                     const CasterGroups* groups, std::span<const ShadowMapToDraw> maps, graph::Resource distances,
                     const ShadowMapScratch& scratch);

/// Draws placements over what maps hold: the nearer stays. Tiles that may change are listed in `scratch.changed`.
void add_over_shadow_maps(const FrameContext& frame, const gpu_scene::GpuScene& scene,
                          const gpu_scene::SceneFrame& poses, std::span<const ShadowMapToDraw> maps,
                          graph::Resource distances, const ShadowMapScratch& scratch);

/// Puts the tiles that are listed in `scratch.changed` back as they are in `still`, and empties the list.
void restore_shadow_maps(const FrameContext& frame, graph::Resource still, graph::Resource distances,
                         const ShadowMapScratch& scratch);

/// The shaders that draw them.
void add_shadow_map_shaders(Digest& digest);

}  // namespace vesper::render
