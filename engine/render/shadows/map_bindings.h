// Bindings of shaders that rasterize into shadow maps. SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "graph/frame_graph.h"
#include "render/shadows/shadow_map_layout.h"

namespace vesper::render {

/// Where shadow maps are drawn.
struct MapTargets {
    graph::Resource quadrants;  ///< shared::MapQuadrant, list
    graph::Resource words;      ///< texels: ShadowMapScratch::drawn, or those of all maps
    graph::Resource changed;    ///< as ShadowMapScratch::changed
    bool over = false;          ///< over what maps hold; tiles that change are listed
    uint32_t side = 0;          ///< texels, of the largest hemisphere
};

/// Bindings 0 to 2 of caster_triangles and masked_casters (.vert and .frag).
inline constexpr VkDescriptorType kMapBindings[]{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                                 VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
/// Descriptors of these. Refers to itself.
class MapBindings {
public:
    MapBindings(const graph::Recording& recording, const MapTargets& to) {
        for (uint32_t i = 0; const graph::Resource buffer : {to.quadrants, to.words, to.changed}) {
            buffers_[i] = {recording.buffer(buffer), recording.offset(buffer), recording.bytes(buffer)};
            writes_[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                          .dstBinding = i,
                          .descriptorCount = 1,
                          .descriptorType = kMapBindings[i],
                          .pBufferInfo = &buffers_[i]};
            ++i;
        }
    }
    MapBindings(const MapBindings&) = delete;

    std::span<VkWriteDescriptorSet> writes() { return writes_; }

private:
    std::array<VkDescriptorBufferInfo, 3> buffers_;
    std::array<VkWriteDescriptorSet, 3> writes_;
};

/// The uses that belong to them, and `others`.
inline std::vector<graph::Use> map_uses(const MapTargets& to, std::initializer_list<graph::Use> others) {
    std::vector<graph::Use> uses(others);
    uses.insert(uses.end(), {graph::load(to.quadrants), graph::update(to.words), graph::update(to.changed)});
    return uses;
}

/// Puts every hemisphere in the corner of a raster pass, with the same bits whatever its extent.
inline void set_map_viewport(VkCommandBuffer commands) {
    static_assert(shared::kRasterSide == kMostMapSide);
    const VkViewport viewport{0, 0, float(shared::kRasterSide), float(shared::kRasterSide), 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
}

}  // namespace vesper::render
