// Runs single passes on a device under core and synchronization validation. SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gpu/device.h"
#include "graph/executor.h"
#include "render/frame_context.h"

namespace vesper::test {

/// A device under validation, with all that was compiled for it. The tests of a process share it.
struct RigDevice {
    explicit RigDevice(bool as_least)
        : device({.select = "",
                  .as_gpu = std::getenv("VESPER_TEST_AS_GPU") != nullptr,
                  .as_least = as_least,
                  .validation = true,
                  .on_message = [this](const std::string& message) { messages->push_back(message); }}),
          kernels(device),
          pipelines(device) {}

    std::shared_ptr<std::vector<std::string>> messages = std::make_shared<std::vector<std::string>>();
    gpu::Device device;
    gpu::KernelCache kernels;
    gpu::GraphicsPipelineCache pipelines;
};

/// Opens the devices when a test first asks for them, and closes them after the last test. A message of the validation
/// layer at the end, of an object that was left, fails the process.
class RigDevices : public testing::Environment {
public:
    RigDevice& get(bool as_least) {
        std::unique_ptr<RigDevice>& device = devices_[as_least];
        if (!device) device = std::make_unique<RigDevice>(as_least);
        return *device;
    }
    void TearDown() override {
        for (std::unique_ptr<RigDevice>& device : devices_) {
            if (!device) continue;
            const auto messages = device->messages;
            messages->clear();
            device.reset();
            for (const std::string& message : *messages) ADD_FAILURE() << message;
        }
    }

private:
    std::unique_ptr<RigDevice> devices_[2];
};

inline RigDevices& rig_devices =
    static_cast<RigDevices&>(*testing::AddGlobalTestEnvironment(new RigDevices));  // of GoogleTest

/// An executor on the device of the process. Make one per test: `complaints()` must be empty at its end.
class PassRig {
public:
    /// `as_least`: see gpu::DeviceOptions.
    explicit PassRig(bool as_least = std::getenv("VESPER_TEST_AS_LEAST") != nullptr)
        : shared_(rig_devices.get(as_least)), first_(shared_.messages->size()), executor_(shared_.device) {}
    PassRig(const PassRig&) = delete;
    PassRig& operator=(const PassRig&) = delete;
    /// Fails the test if there is a message that it has not seen.
    ~PassRig() {
        executor_.reset();
        if (shared_.messages->size() > seen_) ADD_FAILURE() << complaints();
    }

    gpu::Device& device() { return shared_.device; }
    const gpu::KernelCache& kernels() const { return shared_.kernels; }
    /// A frame to add passes to, of a view or of an image of any view.
    render::FrameContext frame(graph::FrameGraph& graph, const gpu_scene::View& view) const {
        return {graph, shared_.kernels, shared_.pipelines, view};
    }
    render::FrameContext frame(graph::FrameGraph& graph, VkExtent2D extent) const {
        return frame(graph, gpu_scene::View{.extent = extent});
    }
    graph::Executor& executor() { return *executor_; }
    /// Validation messages since the rig was made, one per line; empty is what every test wants.
    std::string complaints() const {
        std::string all;
        for (seen_ = first_; seen_ < shared_.messages->size(); ++seen_) all += (*shared_.messages)[seen_] + "\n";
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
    void run(const graph::FrameGraph& graph) { executor_->run(graph); }
    template <class T>
    std::vector<T> got(graph::Resource wanted) const {
        const auto bytes = executor_->read(wanted);
        std::vector<T> values(bytes.size() / sizeof(T));
        std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
        return values;
    }

private:
    RigDevice& shared_;
    size_t first_;                  // of the messages of this test
    mutable size_t seen_ = first_;  // of the messages that the test has asked for
    std::optional<graph::Executor> executor_;
};

}  // namespace vesper::test
