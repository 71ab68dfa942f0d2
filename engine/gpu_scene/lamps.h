// The scene's lamps as the shaders see them. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/intensity_tables.h"
#include "gpu_scene/view.h"
#include "scene/lamp.h"
#include "shared/lamp.h"

namespace vesper::scene {
struct Scene;
}

namespace vesper::gpu_scene {

/// Lamps in the view frame, sorted by kind as shared::LampCounts says.
struct LampList {
    std::vector<shared::Lamp> lamps;
    std::vector<uint32_t> indices;  ///< of each in the PlacedLamps that it was made from
    shared::LampCounts counts{0, 0, 0, 0};

    /// Number of lamps that have a place: all but directional ones, which come last.
    uint32_t placed() const { return counts.cones + counts.powers + counts.tables; }
};

/// A lamp of a scene placed at a node.
struct PlacedLamp {
    scene::Lamp lamp;
    uint32_t node;
};
std::vector<PlacedLamp> placed_lamps(const scene::Scene& scene);

/// Lamps at the poses of a frame, as the view sees them. Lamps of no intensity are left out.
LampList lamp_list(const std::vector<PlacedLamp>& lamps, const IntensityTables& tables, const SceneFrame& frame,
                   const View& view);

/// The LDR baseline's lamps: of intensity 1.0, that is, lighting a surface `reference_distance` (m) away on their axis
/// with 1.0, and of a colour whose largest component is 1.
void set_to_one(LampList& list, float reference_distance);

}  // namespace vesper::gpu_scene
