// The light that surfaces at rest send each other, from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/irradiance_cells.h"
#include "graph/frame_graph.h"
#include "render/passes/indirect.h"
#include "render/passes/moving_light.h"
#include "transport/radiosity.h"

namespace vesper::render {

/// Holds on the device what frames are lit with. Solves anew, on the host, when lamps, emission or the sky have changed
/// since, and declares what brings the device up to date in the graph of a frame.
class IndirectLight {
public:
    /// Throws Error if the device has no room.
    IndirectLight(const gpu::Device& device, std::shared_ptr<const transport::Radiosity> radiosity);

    /// What moves (per node; empty: nothing) gives no light to it. Host work only. Returns whether anything stands
    /// still.
    bool solve(const transport::RadiosityLight& light, const std::vector<bool>& moving);
    /// Declares what solve() found; declared again, nothing is left to bring.
    IndirectCells cells(graph::FrameGraph& graph, const transport::RadiosityLight& light);
    /// The bodies that hide it, and `patches`, as a view sees them.
    MovingLight moving(graph::FrameGraph& graph, std::span<const transport::LitPatch> patches,
                       const gpu_scene::SceneFrame& poses, const gpu_scene::View& view) const;
    /// A frame that was declared has failed: the next one brings all of it again.
    void forget() { lit_.reset(); }
    uint64_t device_bytes() const { return arena_.bytes(); }

private:
    struct Lit {                     // by what the cells are lit
        std::vector<float> factors;  // of sources_
        glm::dvec3 sky{0};
        uint32_t reflections = 0;
        double reflection_error = 0;
        bool operator==(const Lit&) const = default;
    };

    std::shared_ptr<const transport::Radiosity> radiosity_;
    std::vector<uint32_t> sources_;  // nodes: others, such as lamps that move, may be dimmed without effect
    std::optional<Lit> lit_;
    gpu_scene::IrradianceCells table_;  // to be brought to the device; empty: it has it
    uint32_t log2_places_ = 1;
    uint64_t bytes_ = 0, volume_bytes_ = 0;
    gpu::Arena arena_;
    gpu::OwnedBuffer texels_, volumes_;
};

}  // namespace vesper::render
