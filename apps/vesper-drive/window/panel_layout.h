// Where panels stand in the window. SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace vesper::drive {

constexpr float kStatusHeight = 76;  ///< px at the lower edge that panels leave to the line of what is driven and seen

struct PanelPlace {
    glm::vec2 corner, size;  ///< px from the window's upper left corner
};

/// A panel of that size at that place, in a window of 924 x 724 px or more; negative places are from the right edge and
/// from the lower one. In a smaller window all panels shrink alike, and none leaves it: what has no room in a panel is
/// scrolled to.
PanelPlace panel_place(glm::vec2 place, glm::vec2 size, glm::vec2 window);

}  // namespace vesper::drive
