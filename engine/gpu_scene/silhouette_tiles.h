// Silhouettes in the image, and which squares of pixels they touch. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <vulkan/vulkan_core.h>
#include <glm/glm.hpp>

namespace vesper::gpu_scene {

/// What the shaders that draw silhouettes read.
struct SilhouetteList {
    std::vector<glm::vec2> silhouettes;  ///< vertices of all, px from the silhouette's origin, x right and y down, of
                                         ///< positive area
    std::vector<glm::uvec4> tiles;       ///< of kLuminaireTile px: column, row, first entry, entries; row by row
    std::vector<uint32_t> entries;       ///< a silhouette, ascending in a tile, and kCoversTile
};

/// Makes such a list.
class SilhouetteTiles {
public:
    explicit SilhouetteTiles(VkExtent2D image);

    struct Place {
        glm::vec2 origin;  ///< px, whole
        uint32_t first, vertices;
    };
    /// The next silhouette: convex, not empty, within the image, px.
    Place add(std::span<const glm::dvec2> polygon);
    /// The tiles that a silhouette would touch, and the most silhouettes that one of them has.
    struct Load {
        size_t tiles;
        uint32_t most;
    };
    Load load_of(std::span<const glm::dvec2> polygon) const;
    size_t entries() const { return touched_.size(); }
    SilhouetteList list() const;

private:
    struct Touched {
        uint32_t tile;  // row by row
        uint32_t entry;
    };
    VkExtent2D image_;
    uint32_t columns_;
    uint32_t count_ = 0;
    std::vector<glm::vec2> silhouettes_;
    std::vector<Touched> touched_;
    std::vector<uint32_t> counts_;  // of silhouettes, by tile
};

}  // namespace vesper::gpu_scene
