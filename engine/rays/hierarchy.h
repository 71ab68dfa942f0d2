// A hierarchy of boxes about triangles. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "rays/triangles.h"

namespace vesper::rays {

/// Four floats that the processor computes at once; operators work on each.
using Lanes = float __attribute__((vector_size(16)));
using LaneFlags = int32_t __attribute__((vector_size(16)));  ///< of comparisons: -1 or 0

/// Four boxes, each by kRounding larger than its contents. A box holds another node, or 1 to kLeafSize triangles that
/// follow one another.
struct alignas(64) Node {
    static constexpr uint32_t kWidth = 4;
    Lanes bounds[2][3];      ///< low and high ends by axis, m; low > high: there is no such box
    uint32_t first[kWidth];  ///< the node, or the first triangle
    uint32_t count[kWidth];  ///< of triangles; 0: a node
};

constexpr uint32_t kLeafSize = 4;
/// Boxes within boxes: a ray has at most kMostOpen of them before it (three of each level that it has entered).
constexpr uint32_t kMostLevels = 80, kMostOpen = 3 * kMostLevels + 4;

/// Of the size of each triangle: more than RayCaster rounds its corners by, beside a ray.
constexpr float kRounding = 0x1p-20f;

/// Puts triangles into the order of the boxes and returns the nodes, the root first; none for no triangles. Splits
/// follow the surface area heuristic in 16 bins of each axis. The same triangles give the same nodes. Takes up to
/// kBytesWhileBuilding for each triangle, beside the triangles. Throws Error if the time of a Budget is over.
std::vector<Node> build_hierarchy(std::span<Triangle> triangles);

/// n triangles, n > 4, have at most (n - 2) / 3 nodes: a node has four boxes, or all of its boxes are leaves.
constexpr uint64_t kNodeBytesOfTriangle = (sizeof(Node) + 2) / 3;
constexpr uint64_t kBytesWhileBuilding = kNodeBytesOfTriangle + 2 * sizeof(glm::vec4);

}  // namespace vesper::rays
