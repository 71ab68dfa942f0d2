// Parts of a picture whose light is taken together, for far away parts of the eye. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "vision/image_angles.h"

namespace vesper::vision {

/// Nodes of sums of light. Nodes of level 0 are the pixels of a picture; nodes of level k are every 2^k-th pixel along
/// both axes (the last may lie beyond the picture). Each node sums the light under a tent, 1 at the node and 0 at its
/// neighbours, so a level keeps all light and its centre. A tent is the tent of the level below at its node, plus half
/// of its neighbours there.
struct LightNodes {
    std::vector<glm::ivec2> sizes;  ///< of each level, columns and rows
    std::vector<uint32_t> first;    ///< of each level, among the nodes of all

    explicit LightNodes(const ImageAngles&);
    int levels() const { return int(sizes.size()); }
    uint32_t index(int level, glm::ivec2 node) const {
        return first[size_t(level)] + uint32_t(node.y) * uint32_t(sizes[size_t(level)].x) + uint32_t(node.x);
    }
    /// Its place, px from the top left corner.
    static glm::dvec2 place(int level, glm::ivec2 node) { return double(1 << level) * glm::dvec2(node) + 0.5; }
};

}  // namespace vesper::vision
