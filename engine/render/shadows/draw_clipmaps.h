// Clipmaps of directional lamps, drawn. SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "render/frame_context.h"
#include "render/shadows/clipmap_layout.h"

namespace vesper::render {

/// A level that is drawn.
struct LevelToDraw {
    glm::dmat3 rotation{1};  ///< from the world's axes to the map's; z is the way of the light
    glm::dvec3 middle{0};    ///< of its square, m, in these axes
    double half_width = 0;   ///< m
    uint64_t first = 0;      ///< texel
};

/// Draws everything, at the poses of `poses`, into levels of `side` texels, of `distances`: r32ui, two halves a word
/// (shared/clipmap.h). Surfaces hide a lamp from both sides; masked ones where they are drawn, clear ones not
/// at all. Parts smaller than half a texel are left out.
void add_clipmaps(const FrameContext& frame, const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses,
                  std::span<const LevelToDraw> levels, uint32_t side, graph::Resource distances,
                  graph::Resource scratch);

/// The image in which levels of `side` texels are drawn, one after the other; reserved in every frame that has
/// clipmaps, drawn or not.
graph::Resource add_level_scratch(graph::FrameGraph& graph, uint32_t side);

}  // namespace vesper::render
