// Flat openings as convex polygons in the image, in double. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gpu_scene/view.h"

namespace vesper::gpu_scene {

/// A rectangle, or an ellipse, in the view frame.
struct Opening {
    glm::dvec3 centre;         ///< m
    glm::dvec3 across, along;  ///< half axes, at right angles, m
    bool round = false;
};

struct Silhouette {
    std::vector<glm::dvec2> vertices;  ///< px, convex, of positive area with y down; empty: nothing to see
    double widening = 1;               ///< drawn area over true area
};

/// What the view sees of an opening: before its near plane and within its image. An ellipse becomes a polygon of the
/// same area, within 0.05 px of it up to 300 px in radius. Half axes of less than `smallest` px are widened to that.
Silhouette project(const Opening& opening, const View& view, double smallest);

}  // namespace vesper::gpu_scene
