#include "window/panel_layout.h"

namespace vesper::drive {

PanelPlace panel_place(glm::vec2 place, glm::vec2 size, glm::vec2 window) {
    constexpr glm::vec2 kRoom(924, 648), kLeast(200, 120);  // what two columns of panels need; what one can be read in
    constexpr float kMargin = 8;
    const glm::vec2 room(window.x, glm::max(window.y - kStatusHeight, window.y / 2));
    const glm::vec2 scale = glm::min(room / kRoom, glm::vec2(1)), most = glm::max(room - 2 * kMargin, glm::vec2(1));
    const glm::vec2 made = glm::min(glm::max(size * scale, kLeast), most);
    glm::vec2 corner = place * scale;
    for (int axis = 0; axis < 2; ++axis)
        if (corner[axis] < 0) corner[axis] += room[axis] - made[axis];
    return {glm::clamp(corner, glm::vec2(0), room - made), made};
}

}  // namespace vesper::drive
