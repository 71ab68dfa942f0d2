// Where a projector shows the parts of a picture: a mesh. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vesper::vision {

/// A node: a place on the projector's picture, and what is shown there.
struct WarpNode {
    double x = 0, y = 0;   ///< in halves of the height: x from -aspect to aspect, y from -1 to 1, up
    double u = 0, v = 0;   ///< place in the rendered picture, 0 to 1 from its left and from its bottom
    double intensity = 1;  ///< factor of light, 0 to 1; negative: the node is not drawn
};

/// A mesh over the projector's picture, whose aspect is width / height.
struct WarpMesh {
    std::string name;                ///< of its file, for messages
    uint32_t columns = 0, rows = 0;  ///< of nodes, kLeastWarpNodes to kMostWarpNodes
    std::vector<WarpNode> nodes;     ///< row by row, as in the file
};

constexpr uint32_t kLeastWarpNodes = 2, kMostWarpNodes = 1024;  ///< each way
constexpr uint64_t kMaxWarpMeshBytes = 64u << 20;
/// Largest magnitude of x and y, and of what nodes that are not drawn have for u and v.
constexpr double kFarthestWarpNode = 100;

/// Reads a mesh in Paul Bourke's text format: a line with the type (2, rectangular: no other is read), one with the
/// numbers of columns and rows, and one of "x y u v i" for each node. Empty lines are passed over. Throws Error, naming
/// file, line and reason.
WarpMesh parse_warp_mesh(std::span<const uint8_t> text, const std::string& name);
WarpMesh read_warp_mesh(const std::filesystem::path& file);

}  // namespace vesper::vision
