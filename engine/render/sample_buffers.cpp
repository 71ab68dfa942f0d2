#include "render/sample_buffers.h"

#include <string>

#include <glm/glm.hpp>

#include "base/error.h"

namespace vesper::render {

void SampleBuffers::resize(const gpu::Device& device, uint64_t pixels) {
    if (pixels == pixels_) return;
    const uint64_t most = device.limits().maxStorageBufferRange / sizeof(glm::vec4);
    if (pixels > most)
        throw Error("a picture of " + std::to_string(pixels) + " px cannot have samples on this device, which takes " +
                    std::to_string(most) + " px");
    pixels_ = 0, sums_ = {}, rests_ = {};
    arena_.emplace(device);
    for (gpu::OwnedBuffer* buffer : {&sums_, &rests_}) {
        *buffer = gpu::make_buffer(device, pixels * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        arena_->bind(buffer->get());
    }
    pixels_ = pixels;
}

SampleSums SampleBuffers::declare(graph::FrameGraph& graph) const {
    const auto buffer = [&](const char* name, const gpu::OwnedBuffer& owned) {
        return graph.persistent(name, owned, pixels_ * sizeof(glm::vec4));
    };
    return {buffer("sums of samples", sums_), buffer("rests of samples", rests_)};
}

}  // namespace vesper::render
