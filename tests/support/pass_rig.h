// Runs single passes on a device under core and synchronization validation. SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "graph/executor.h"
#include "render/frame_context.h"

namespace vesper::test {

/// A device, its kernels and an executor. Make one per test: `complaints()` must be empty at its end.
class PassRig {
public:
    /// `as_least`: see gpu::DeviceOptions.
    explicit PassRig(bool as_least = std::getenv("VESPER_TEST_AS_LEAST") != nullptr)
        : device_({.select = "",
                   .as_gpu = std::getenv("VESPER_TEST_AS_GPU") != nullptr,
                   .as_least = as_least,
                   .validation = true,
                   .on_message = [this](const std::string& message) { complaints_.push_back(message); }}),
          kernels_(device_),
          pipelines_(device_),
          executor_(device_) {}

    gpu::Device& device() { return device_; }
    const gpu::KernelCache& kernels() const { return kernels_; }
    /// A frame to add passes to, of a view or of an image of any view.
    render::FrameContext frame(graph::FrameGraph& graph, const gpu_scene::View& view) const {
        return {graph, kernels_, pipelines_, view};
    }
    render::FrameContext frame(graph::FrameGraph& graph, VkExtent2D extent) const {
        return frame(graph, gpu_scene::View{.extent = extent});
    }
    graph::Executor& executor() { return executor_; }
    /// Validation messages so far, one per line; empty is what every test wants.
    std::string complaints() const {
        std::string all;
        for (const std::string& message : complaints_) all += message + "\n";
        return all;
    }

    /// An image with the given texels, tightly packed.
    template <class T>
    static graph::Resource image(graph::FrameGraph& graph, const std::string& name, VkFormat format, VkExtent2D extent,
                                 const std::vector<T>& texels) {
        const graph::Resource from = graph.upload(name + " texels", texels);
        const graph::Resource to = graph.transient(name, graph::image_shape(format, extent));
        graph.copy("fill " + name, from, to);
        return to;
    }
    /// A buffer with the given values that a pass may read as storage.
    template <class T>
    static graph::Resource buffer(graph::FrameGraph& graph, const std::string& name, const std::vector<T>& values,
                                  VkFormat texel = VK_FORMAT_UNDEFINED) {
        const graph::Resource from = graph.upload(name + " values", values);
        const graph::Resource to = graph.transient(name, graph::buffer_shape(values.size() * sizeof(T), texel));
        graph.copy("fill " + name, from, to);
        return to;
    }

    /// Asks for a resource of `count` values of T after the frame. Call before run.
    template <class T>
    static graph::Resource want(graph::FrameGraph& graph, graph::Resource from, size_t count) {
        const graph::Resource to = graph.readback("wanted " + std::to_string(from.index), count * sizeof(T));
        graph.copy("fetch " + std::to_string(from.index), from, to);
        return to;
    }
    void run(const graph::FrameGraph& graph) { executor_.run(graph); }
    template <class T>
    std::vector<T> got(graph::Resource wanted) const {
        const auto bytes = executor_.read(wanted);
        std::vector<T> values(bytes.size() / sizeof(T));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
        return values;
    }

private:
    std::vector<std::string> complaints_;
    gpu::Device device_;
    gpu::KernelCache kernels_;
    gpu::GraphicsPipelineCache pipelines_;
    graph::Executor executor_;
};

}  // namespace vesper::test
