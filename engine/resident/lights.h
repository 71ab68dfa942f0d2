// The scene's lamps as the shaders see them. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "resident/light_maps.h"
#include "resident/resident_scene.h"
#include "resident/view.h"
#include "scene/scene.h"
#include "shared/light.h"

namespace vesper {

/// Lights in the view frame, sorted by kind as shared::LightCounts says.
struct LightList {
    std::vector<shared::Light> lights;
    shared::LightCounts counts{0, 0, 0, 0};

    /// Lamps, that is, all but directional lights.
    uint32_t lamps() const { return counts.cones + counts.powers + counts.maps; }
};

/// A light of a scene placed at a node.
struct PlacedLight {
    Light light;
    uint32_t node;
};
std::vector<PlacedLight> placed_lights(const Scene& scene);

/// Lights at the poses of a frame, as the view sees them. Lamps of no intensity are left out.
LightList light_list(const std::vector<PlacedLight>& lights, const LightMaps& maps, const SceneFrame& frame, const View& view);

/// The LDR baseline's lights: of intensity 1.0, that is, lighting a surface `reference_distance` (m) away on their axis
/// with 1.0, and of a colour whose largest component is 1.
void set_to_one(LightList& list, float reference_distance);

}  // namespace vesper
