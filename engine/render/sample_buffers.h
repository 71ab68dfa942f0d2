// Sums of samples of pixels on the device. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "gpu/memory.h"
#include "render/passes/samples.h"

namespace vesper::render {

/// Keeps the sums of the frame that is being sampled. Nothing before it is needed.
class SampleBuffers {
public:
    /// For `pixels` pixels, while no frame uses the buffers. Throws Error if the device has no room.
    void resize(const gpu::Device& device, uint64_t pixels);
    SampleSums declare(graph::FrameGraph& graph) const;
    uint64_t bytes() const { return arena_ ? arena_->bytes() : 0; }

private:
    uint64_t pixels_ = 0;
    std::optional<gpu::Arena> arena_;
    gpu::OwnedBuffer sums_, rests_;
};

}  // namespace vesper::render
