// The selection of casters: surfaces whose shadows a view may see. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/lamps.h"
#include "gpu_scene/view.h"
#include "render/shadows/shadow_map_layout.h"

namespace vesper::render {

/// The points p with dot(inward, p) >= offset.
struct HalfSpace {
    glm::dvec3 inward{0};  ///< unit vector
    double offset = 0;     ///< m
};

/// Half spaces that hold a lamp's place and all that a view may see, and so every straight way between them; and the
/// ways beyond what is seen, up to `reach` (at least 1) times as far from the lamp. World, m.
std::vector<HalfSpace> light_paths(const gpu_scene::View& view, glm::dvec3 lamp, double reach = 1);

/// Whether some of a sphere lies in all of the half spaces. May be true where none does.
bool may_lie_in(const std::vector<HalfSpace>& spaces, const gpu_scene::WorldSphere& sphere);

/// The largest intensity of a lamp of a list towards a sphere, cd; of a measured one, of all directions. `number`: in
/// the list; `to`: from the lamp to the middle of the sphere, m, in the frame of the view.
double intensity_towards(const gpu_scene::LampList& list, uint32_t number, glm::dvec3 to, double radius);

/// Whether surfaces in a sphere (world, m) may cast a shadow that is wanted.
using IsCaster = std::function<bool(const gpu_scene::WorldSphere&)>;

/// A lamp whose casters are selected.
struct CastingLamp {
    uint32_t number;      ///< in the list
    glm::dvec3 position;  ///< m, world
    const ShadowMapLayout& layout;
    double least_light;  ///< lx: light below casts no shadow
};
/// Selects the casters of a lamp of a list: surfaces that get enough light of it, undimmed, so that its map serves at
/// any dimming. `culled`: only those on its paths to what the view sees, with room for penumbrae. The list must outlive
/// the result.
IsCaster select_casters(const CastingLamp& lamp, const gpu_scene::LampList& list, const gpu_scene::View& view,
                        bool culled);

}  // namespace vesper::render
