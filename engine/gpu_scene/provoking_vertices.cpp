#include "gpu_scene/provoking_vertices.h"

#include <algorithm>
#include <numeric>

namespace vesper::gpu_scene {

ProvokingVertices::ProvokingVertices(const scene::Primitive& primitive)
    : vertices_(primitive.vertices.size()), indices_(primitive.indices) {
    std::iota(vertices_.begin(), vertices_.end(), 0u);
    std::vector<bool> leads(vertices_.size());
    for (size_t i = 0; i + 3 <= indices_.size(); i += 3) {
        const auto corners = indices_.begin() + std::ptrdiff_t(i);
        const auto free = std::find_if(corners, corners + 3, [&](uint32_t vertex) { return !leads[vertex]; });
        if (free != corners + 3) {
            std::rotate(corners, free, corners + 3);
            leads[*corners] = true;
        } else {
            vertices_.push_back(vertices_[*corners]);
            *corners = uint32_t(vertices_.size() - 1);
        }
    }
}

}  // namespace vesper::gpu_scene
