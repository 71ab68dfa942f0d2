// The selection of casters: surfaces whose shadows a view may see. SPDX-License-Identifier: MIT
#pragma once

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

/// A lamp whose casters are selected.
struct CastingLamp {
    uint32_t number;      ///< in the list
    glm::dvec3 position;  ///< m, world
    const ShadowMapLayout& layout;
    double least_light;  ///< lx: light below casts no shadow
};
/// Selects the casters of a lamp of a list: surfaces that get enough light of it, undimmed, so that its map serves at
/// any dimming.
class IsCaster {
public:
    /// All surfaces are.
    IsCaster() = default;
    /// `culled`: only those on its paths to what the view sees, with room for penumbrae. The list must outlive this.
    IsCaster(const CastingLamp& lamp, const gpu_scene::LampList& list, const gpu_scene::View& view, bool culled);

    /// Whether surfaces in a sphere (world, m) may cast a shadow that is wanted; if not, those in no sphere within it
    /// may, but for rounding.
    bool operator()(const gpu_scene::WorldSphere& sphere) const;

private:
    const gpu_scene::LampList* list_ = nullptr;
    uint32_t number_ = 0;
    glm::dvec3 position_{0};
    glm::dmat3 to_view_{1};
    std::vector<HalfSpace> paths_;
    double beside_ = 0, texels_ = 0;  // room around a sphere: m, and per m away
    double share_ = 0, least_ = 0;    // of the intensity, undimmed; lx
};

}  // namespace vesper::render
