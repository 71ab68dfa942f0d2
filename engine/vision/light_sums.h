// Sums of the light of a picture, for far away parts. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "vision/scatter_fit.h"

namespace vesper::vision {

/// Nodes of the sums. Nodes of level 0 are the pixels of a picture; nodes of level k are every 2^k-th pixel along both
/// axes (the last may lie beyond the picture). Each node sums the light under a tent, 1 at the node and 0 at its
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

/// The light of one picture at its nodes.
class LightSums {
public:
    explicit LightSums(const ImageAngles&);

    /// RGBA, cd/m^2, rows from the top; pixels that are not finite have no light. The data must stay valid until the
    /// next call.
    void take(std::span<const float> rgba);
    /// Of a node (LightNodes::index): RGB lx, on a plane at the eye that faces it.
    glm::vec3 at(uint32_t node) const;
    std::vector<glm::vec3> at(std::span<const uint32_t> nodes) const;
    const LightNodes& nodes() const { return nodes_; }

private:
    glm::vec4 pixel(size_t index) const;

    LightNodes nodes_;
    std::vector<float> steradians_;  // of each pixel
    std::vector<glm::vec4> coarse_;  // of nodes from level 1 on
    std::span<const float> rgba_;
};

}  // namespace vesper::vision
