// A frame graph whose kernels are made up to fit its uses, for tests of the plan. SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <initializer_list>
#include <string>
#include <vector>

#include "graph/frame_graph.h"

namespace vesper::test {

inline constexpr VkExtent2D kExtent{64, 32};  // px; an RGBA8 image of it has 8192 bytes

/// The kernel for which these uses are right.
inline gpu::KernelInterface fitting_kernel(const graph::FrameGraph& graph, std::initializer_list<graph::Use> uses) {
    gpu::KernelInterface kernel;
    kernel.name = "made-up.comp";
    for (const graph::Use& use : uses) {
        const graph::Shape& shape = graph.resources()[use.resource.index].shape;
        const bool sampled = use.access == graph::Access::Sample, texels = shape.format != VK_FORMAT_UNDEFINED;
        if (shape.is_image())
            kernel.bindings.push_back(sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                              : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
        else if (sampled)
            kernel.bindings.push_back(texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                             : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
        else
            kernel.bindings.push_back(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    }
    return kernel;
}

/// Declares a frame in short words.
class DeclaredFrame {
public:
    graph::Resource image(const std::string& name, VkFormat format = VK_FORMAT_R8G8B8A8_UNORM) {
        return graph.transient(name, graph::image_shape(format, kExtent));
    }
    graph::Resource buffer(const std::string& name, uint64_t bytes = 256) {
        return graph.transient(name, graph::buffer_shape(bytes));
    }
    void compute(const std::string& name, std::initializer_list<graph::Use> uses) {
        graph.dispatch(name, kernels_.emplace_back(fitting_kernel(graph, uses)), uses, graph::Groups{});
    }
    /// The same for a list made at run time, of one to three uses.
    void compute(const std::string& name, const std::vector<graph::Use>& uses) {
        if (uses.size() == 1) compute(name, {uses[0]});
        if (uses.size() == 2) compute(name, {uses[0], uses[1]});
        if (uses.size() == 3) compute(name, {uses[0], uses[1], uses[2]});
    }
    void draw(const std::string& name, std::vector<graph::Use> uses) {
        graph.raster(name, std::move(uses), [](const graph::Recording&) {});
    }
    graph::Plan plan() const { return graph.compile(measure); }
    std::string text() const { return graph.describe(plan()); }

    graph::FrameGraph graph;
    graph::Measure measure = [](const graph::Shape& shape, uint32_t) -> graph::Footprint {
        if (!shape.is_image()) return {shape.bytes, 16, 1};
        const uint64_t texel = shape.format == VK_FORMAT_R32G32B32A32_SFLOAT   ? 16
                               : shape.format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8
                                                                               : 4;
        return {texel * shape.extent.width * shape.extent.height, 256, 1};
    };

private:
    std::deque<gpu::KernelInterface> kernels_;  // a deque, as the graph points at them
};

inline graph::Use color(graph::Resource r) { return {r, graph::Access::ColorTarget}; }
inline graph::Use depth(graph::Resource r) { return {r, graph::Access::DepthTarget}; }
inline graph::Use vertices(graph::Resource r) { return {r, graph::Access::Vertices}; }

}  // namespace vesper::test
