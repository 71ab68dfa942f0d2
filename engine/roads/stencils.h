// Paint of stencils: arrows. Not a public header. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "roads/road_network.h"

namespace vesper::roads {

constexpr double kArrowLength = 5;  ///< m, where none is stated: RMS 1980, in towns

/// Directions of an arrow.
struct ArrowShape {
    bool straight = false, left = false, right = false;
};

/// By the words of subtype or name: straight, left, right and their combinations, and names as editors write them
/// (Stencil_ArrowType4L: type 4 with L or R is a turn, type 1 leads straight on).
std::optional<ArrowShape> arrow_of(const RoadObject&);
/// True for stencils of letters, numbers and symbols: they have a shape that the file does not state.
bool is_shapeless(const RoadObject&);
/// m, of an arrow whose width is not stated.
double usual_width(const ArrowShape&);

/// Convex parts of an arrow that fills a rectangle about the origin, m: x ahead, y to the left.
std::vector<std::vector<glm::dvec2>> arrow_parts(const ArrowShape&, double length, double width);

}  // namespace vesper::roads
