// Texels of maps of distances, drawn on the device. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <glm/gtc/packing.hpp>

#include "gpu_scene/gpu_scene.h"
#include "support/pass_rig.h"

namespace vesper::test {

/// What passes leave in `texels` halves, two a word, that held something else before. `declare(frame, words)`: adds
/// them.
template <class Declare>
std::vector<float> drawn_texels(PassRig& rig, uint32_t texels, const Declare& declare) {
    gpu::Arena arena(rig.device());
    const std::vector<uint32_t> nothing(texels / 2, 0x12341234);
    const auto buffer = gpu::upload_buffer(rig.device(), arena, std::as_bytes(std::span(nothing)),
                                           gpu::kTexelUsage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    graph::FrameGraph graph;
    const graph::Resource words = graph.persistent("distances", buffer, texels * 2);
    declare(rig.frame(graph, VkExtent2D{1, 1}), words);
    const graph::Resource distances = PassRig::want<uint32_t>(graph, words, texels / 2);
    rig.run(graph);
    std::vector<float> drawn;
    for (const uint32_t word : rig.got<uint32_t>(distances)) {
        const glm::vec2 two = glm::unpackHalf2x16(word);
        drawn.push_back(two.x), drawn.push_back(two.y);
    }
    return drawn;
}

}  // namespace vesper::test
