// Texels in and out of passes. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "support/pass_rig.h"

namespace vesper::test {

/// For rgba16f images.
inline std::vector<uint64_t> to_halves(std::span<const glm::vec4> texels) {
    std::vector<uint64_t> packed;
    for (const glm::vec4& t : texels) packed.push_back(glm::packHalf4x16(t));
    return packed;
}
inline std::vector<glm::vec4> from_halves(std::span<const uint64_t> packed) {
    std::vector<glm::vec4> texels;
    for (uint64_t p : packed) texels.push_back(glm::unpackHalf4x16(p));
    return texels;
}

/// Asks for the whole of an image or buffer after the frame, as values of T. Call before run.
template <class T>
graph::Resource keep(graph::FrameGraph& graph, graph::Resource from) {
    const graph::Shape shape = graph.resources()[from.index].shape;
    const size_t count = shape.is_image() ? size_t(shape.extent.width) * shape.extent.height : shape.bytes / sizeof(T);
    return PassRig::want<T>(graph, from, count);
}

}  // namespace vesper::test
