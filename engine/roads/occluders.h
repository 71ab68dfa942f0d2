// What stands about a road and hides luminaires. SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "rays/ray_caster.h"
#include "scene/scene.h"

namespace vesper::roads {

/// Trees, buildings, signs: a scene in the frame of layout_scene(), its road at Y = 0. Its nodes are at rest.
class Occluders {
public:
    /// Reads glTF. Throws Error naming the file.
    explicit Occluders(const std::filesystem::path& file);
    explicit Occluders(scene::Scene scene);
    Occluders(const Occluders&) = delete;
    Occluders& operator=(const Occluders&) = delete;

    /// Whether a surface lies between a luminaire and a point, in the frame of a layout (road_layout.h), m. Nothing
    /// within kHousing of the luminaire hides it, nor its own fixture (scene/fixtures.h) if a lamp of the scene is
    /// within kSameLamp of it. Of a point on the road, nothing below kKerb hides one: kerbs, pavements and markings.
    bool hide(glm::dvec3 luminaire, glm::dvec3 point) const;
    static constexpr double kHousing = 0.3, kSameLamp = 1, kKerb = 0.25;

private:
    scene::Scene scene_;
    std::vector<glm::dmat4> world_;
    std::vector<glm::dvec3> lamps_;  ///< places, world
    std::vector<std::vector<uint32_t>> fixtures_;
    rays::RayCaster rays_;
};

}  // namespace vesper::roads
