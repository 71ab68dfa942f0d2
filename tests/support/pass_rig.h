// Runs single passes on a device under core and synchronization validation. SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "graph/executor.h"
#include "render/frame_context.h"

namespace vesper {

/// A device, its kernels and an executor. Make one per test: `complaints()` must be empty at its end.
class PassRig {
public:
    PassRig()
        : device_({.select = "",
                   .validation = true,
                   .on_message = [this](const std::string& message) { complaints_.push_back(message); }}),
          kernels_(device_),
          pipelines_(device_),
          executor_(device_) {}

    Device& device() { return device_; }
    const KernelCache& kernels() const { return kernels_; }
    /// A frame to add passes to, of a view or of an image of any view.
    FrameContext frame(FrameGraph& graph, const View& view) const { return {graph, kernels_, pipelines_, view}; }
    FrameContext frame(FrameGraph& graph, VkExtent2D extent) const { return frame(graph, View{.extent = extent}); }
    Executor& executor() { return executor_; }
    /// Validation messages so far, one per line; empty is what every test wants.
    std::string complaints() const {
        std::string all;
        for (const std::string& message : complaints_) all += message + "\n";
        return all;
    }

    /// An image with the given texels, tightly packed.
    template <class T>
    static Resource image(FrameGraph& graph, const std::string& name, VkFormat format, VkExtent2D extent,
                          const std::vector<T>& texels) {
        const Resource from = graph.upload(name + " texels", texels);
        const Resource to = graph.transient(name, image_shape(format, extent));
        graph.copy("fill " + name, from, to);
        return to;
    }
    /// A buffer with the given values that a pass may read as storage.
    template <class T>
    static Resource buffer(FrameGraph& graph, const std::string& name, const std::vector<T>& values,
                           VkFormat texel = VK_FORMAT_UNDEFINED) {
        const Resource from = graph.upload(name + " values", values);
        const Resource to = graph.transient(name, buffer_shape(values.size() * sizeof(T), texel));
        graph.copy("fill " + name, from, to);
        return to;
    }

    /// Asks for a resource of `count` values of T after the frame. Call before run.
    template <class T>
    static Resource want(FrameGraph& graph, Resource from, size_t count) {
        const Resource to = graph.readback("wanted " + std::to_string(from.index), count * sizeof(T));
        graph.copy("fetch " + std::to_string(from.index), from, to);
        return to;
    }
    void run(const FrameGraph& graph) { executor_.run(graph); }
    template <class T>
    std::vector<T> got(Resource wanted) const {
        const auto bytes = executor_.read(wanted);
        std::vector<T> values(bytes.size() / sizeof(T));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
        return values;
    }

private:
    std::vector<std::string> complaints_;
    Device device_;
    KernelCache kernels_;
    GraphicsPipelineCache pipelines_;
    Executor executor_;
};

}  // namespace vesper
