// Flat openings as convex polygons in the image, in double. SPDX-License-Identifier: MIT
#pragma once

#include <span>
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
    double width = 0, length = 0;      ///< px, of the true one across and along; 0 if part of it is behind the eye
};

/// What the view sees of an opening: before its near plane and within its image. An ellipse becomes a polygon of the
/// same area, within 0.05 px of it up to 300 px in radius. Half axes of less than `smallest` px are widened to that.
Silhouette project(const Opening& opening, const View& view, double smallest);

/// The same of a flat convex polygon of three or four corners, m, in the view frame, in either turn.
Silhouette project(std::span<const glm::dvec3> corners, const View& view, double smallest);

}  // namespace vesper::gpu_scene
