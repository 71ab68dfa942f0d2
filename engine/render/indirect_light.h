// The light that surfaces at rest send each other, from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "graph/frame_graph.h"
#include "render/passes/indirect.h"
#include "render/passes/moving_light.h"
#include "transport/radiosity.h"

namespace vesper::render {

/// Holds what one frame is lit with, and solves anew when lamps, emission or the sky have changed since.
class IndirectLight {
public:
    explicit IndirectLight(std::shared_ptr<const transport::Radiosity> radiosity)
        : radiosity_(std::move(radiosity)), sources_(radiosity_->source_nodes()) {}

    /// What moves (per node; empty: nothing) gives no light to it. `wait` is called before anything that a frame may
    /// use is replaced. Throws Error.
    IndirectCells cells(graph::FrameGraph& graph, const gpu::Device& device, const transport::RadiosityLight& light,
                        const std::vector<bool>& moving, const std::function<void()>& wait);
    /// The bodies that hide it, and `patches`, as a view sees them. Throws Error.
    MovingLight moving(graph::FrameGraph& graph, const gpu::Device& device,
                       std::span<const transport::LitPatch> patches, const gpu_scene::SceneFrame& poses,
                       const gpu_scene::View& view);
    uint64_t device_bytes() const { return bytes_ + volume_bytes_; }

private:
    struct Lit {                     // by what the cells are lit
        std::vector<float> factors;  // of sources_
        glm::dvec3 sky{0};
        uint32_t reflections = 0;
        double left_out = 0;
        bool operator==(const Lit&) const = default;
    };

    std::shared_ptr<const transport::Radiosity> radiosity_;
    std::vector<uint32_t> sources_;  // nodes: others, such as lamps that move, may be dimmed without effect
    std::optional<Lit> lit_;
    std::optional<gpu::Arena> arena_;
    gpu::OwnedBuffer texels_;
    uint64_t bytes_ = 0;
    uint32_t log2_places_ = 1;
    std::optional<gpu::Arena> volume_arena_;
    gpu::OwnedBuffer volumes_;
    uint64_t volume_bytes_ = 0;
};

}  // namespace vesper::render
