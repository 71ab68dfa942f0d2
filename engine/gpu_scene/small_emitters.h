// Emitting surfaces that are about as small as a pixel. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gpu_scene/emitting_parts.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/silhouette_tiles.h"
#include "shared/small_emitter.h"

namespace vesper::gpu_scene {

/// Parts whose triangles are all narrower than this are drawn by the area that these cover, px: by the ellipse of a
/// triangle, so that a square has 10.
constexpr double kSmallEmitter = 8;
/// With a texture they must also be less long than this, px; with bars before it, which come and go otherwise, than
/// that.
constexpr double kLongestTextured = 4, kLongestFramed = 12;
/// Wider triangles with a texture are drawn as four: of each the mean luminance is shown. px
constexpr double kOneLuminance = 1.5;
/// Facets of a frame that are wider are not listed: the middle of some pixel sees them. px
constexpr double kFrameWidth = 3;
/// Parts of which a tile, or a frame, would get more, or which would give the tiles more entries, are drawn as other
/// surfaces are.
constexpr uint32_t kMostSmallEmittersOfTile = 1000, kMostSmallEmitters = 16'384, kMostEntries = 1u << 18;

/// Small emitters in view, and what may hide them. Silhouette i is that of emitter i.
struct SmallEmitterList : SilhouetteList {
    std::vector<shared::SmallEmitter> emitters;
    /// Parts that it has, which are to be drawn without their emission: by number, counted over all parts of
    /// GpuScene::placements(), ascending.
    std::vector<uint32_t> parts;
};

SmallEmitterList small_emitter_list(const std::vector<EmittingPart>& parts, const GpuScene& scene,
                                    const SceneFrame& frame, const View& view);

}  // namespace vesper::gpu_scene
