// What a plane picture covers, seen from the eye. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace vesper::vision {

/// A picture on the plane one unit before the eye.
struct ImageAngles {
    int width = 1, height = 1;    ///< px
    glm::dvec2 low{-1}, high{1};  ///< tangents of its left and bottom, and of its right and top edge

    /// Tangents at a point, px from the top left corner; x right and y up.
    glm::dvec2 at(glm::dvec2 pixels) const { return {low.x + pixels.x * pixel().x, high.y - pixels.y * pixel().y}; }
    /// Where a point of the plane lies, px from the top left corner.
    glm::dvec2 pixels_at(glm::dvec2 tangents) const {
        return {(tangents.x - low.x) / pixel().x, (high.y - tangents.y) / pixel().y};
    }
    /// Tangents across one pixel.
    glm::dvec2 pixel() const { return (high - low) / glm::dvec2(width, height); }
    bool symmetric_x() const { return low.x == -high.x; }
    bool symmetric_y() const { return low.y == -high.y; }
    bool operator==(const ImageAngles&) const = default;
};

}  // namespace vesper::vision
