// Casters that stand still, in groups by place. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"

namespace vesper::render {

/// Spheres around a placement, and around each of its parts.
struct CasterBounds {
    gpu_scene::WorldSphere whole{glm::dvec3(0), 0};
    std::vector<gpu_scene::WorldSphere> parts;
};
/// At a pose.
CasterBounds caster_bounds(const gpu_scene::GpuScene& scene, uint32_t placement, const glm::dmat4& world);

/// Placements that stand still, as cells and parts in groups of some 32 m, so that a lamp need not look at each. To be
/// made anew once other placements stand still.
class CasterGroups {
public:
    /// A cell, or parts of one placement that are in no cell.
    struct Caster {
        gpu_scene::WorldSphere bounds;          ///< of the cell, or of the whole placement
        const gpu_scene::GpuScene::Cell* cell;  ///< or null
        std::span<const gpu_scene::PlacedPart> parts;
    };
    struct Group {
        gpu_scene::WorldSphere bounds;  ///< around those of its casters, and a hair more
        std::vector<Caster> casters;
    };

    /// Of placements `still`, ascending, at these poses. Cells stand if all of their placements stand as the scene has
    /// them. Refers to the scene.
    CasterGroups(const gpu_scene::GpuScene& scene, std::span<const uint32_t> still, const gpu_scene::SceneFrame& poses);
    CasterGroups(const CasterGroups&) = delete;

    const std::vector<Group>& groups() const { return groups_; }
    /// Null if it does not stand still.
    const CasterBounds* bounds(uint32_t placement) const { return stands_[placement] ? &bounds_[placement] : nullptr; }

private:
    void add_groups(const std::vector<Caster>& casters);

    std::vector<bool> stands_;                  // of placements
    std::vector<CasterBounds> bounds_;          // likewise
    std::vector<gpu_scene::PlacedPart> loose_;  // in no cell, ascending
    std::vector<Group> groups_;
};

}  // namespace vesper::render
