// What light there is at a pixel: on the surface that is seen there. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "gpu_scene/lamps.h"
#include "gpu_scene/view.h"
#include "scene/scene.h"

namespace vesper::drive {

struct SurfacePoint {
    glm::dvec3 position{0};      ///< scene, m
    glm::dvec3 normal{0, 1, 0};  ///< towards the eye
    double distance = 0;         ///< from the eye, m
    uint32_t node = scene::kNone;
};

/// The nearest surface behind the middle of a pixel, y down. Holes of masked textures are surfaces here.
std::optional<SurfacePoint> surface_at(const scene::Scene&, const gpu_scene::SceneFrame&, const gpu_scene::View&,
                                       glm::uvec2 pixel);

/// Illuminance of every lamp there, lx, each as I cos / d^2 (as the renderer has it, nothing stands between), without
/// what comes from the sky.
double lamp_illuminance(const scene::Scene&, const gpu_scene::SceneFrame&, const SurfacePoint&);

}  // namespace vesper::drive
