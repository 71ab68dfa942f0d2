// Pipelines that draw triangles, by shaders and what varies between those of the same. SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "gpu/embedded_code.h"
#include "gpu/kernel.h"

namespace vesper::gpu {

/// A vertex and a fragment shader that are embedded in the program, and what they read.
struct GraphicsShaders {
    const char* name;  ///< for messages
    EmbeddedCode vertex, fragment;
    std::span<const VkDescriptorType> bindings;  ///< of both shaders; binding i is the i-th
    uint32_t push_bytes;
    VkShaderStageFlags push_stages;
    std::span<const VkVertexInputBindingDescription> buffers = {};
    std::span<const VkVertexInputAttributeDescription> attributes = {};
};

/// An image that is drawn into.
struct ColourTarget {
    VkFormat format;
    bool written = true;   ///< false: it is kept as it is
    bool blended = false;  ///< by the alpha of what is drawn
    auto operator<=>(const ColourTarget&) const = default;
};

/// What varies between pipelines of the same shaders.
struct GraphicsVariant {
    std::vector<ColourTarget> targets;
    VkFormat depth = VK_FORMAT_UNDEFINED;  ///< of the depth image, if there is one: the largest values are in front
    std::vector<uint32_t> constants = {};  ///< specialization constant i of the fragment shader is the i-th
    auto operator<=>(const GraphicsVariant&) const = default;
};

/// Draws lists of triangles. Viewport, scissor, cull mode and front face are states of the command buffer.
class GraphicsPipeline {
public:
    GraphicsPipeline(const Device& device, const GraphicsShaders& shaders, const GraphicsVariant& variant);

    VkPipeline pipeline() const { return pipeline_.get(); }
    VkPipelineLayout layout() const { return layout_.get(); }
    VkDescriptorSetLayout set_layout() const { return set_.get(); }

private:
    OwnedSetLayout set_;
    OwnedPipelineLayout layout_;
    OwnedPipeline pipeline_;
};

/// Makes each pipeline when it is first asked for, and keeps it. Not thread-safe.
class GraphicsPipelineCache {
public:
    explicit GraphicsPipelineCache(const Device& device) : device_(device) {}

    /// Valid as long as the cache. Throws Error.
    const GraphicsPipeline& get(const GraphicsShaders& shaders, const GraphicsVariant& variant) const;

private:
    using Key = std::tuple<const uint32_t*, const uint32_t*, GraphicsVariant>;  // code of both shaders

    const Device& device_;
    mutable std::map<Key, GraphicsPipeline> pipelines_;
};

}  // namespace vesper::gpu
