// Which placements of a scene move, from frame to frame. SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "gpu_scene/gpu_scene.h"

namespace vesper::render {

/// Placements move once their node is animated, a frame says that it moves, or it was seen at another pose than in the
/// frame before. What has moved once goes on to count as moving.
class MovingPlacements {
public:
    /// `animated`: per node.
    MovingPlacements(const gpu_scene::GpuScene& scene, std::vector<bool> animated)
        : scene_(scene), moves_(std::move(animated)) {}

    /// Takes a frame's poses. Returns the placements that stood still until the last frame and count as moving now.
    std::vector<uint32_t> update(const gpu_scene::SceneFrame& poses);

    bool moves(uint32_t node) const { return moves_[node]; }
    uint64_t version() const { return version_; }                  ///< another one whenever anything has moved
    const std::vector<uint32_t>& still() const { return still_; }  ///< ascending
    struct Moving {
        uint32_t placement;
        uint64_t version;   ///< another one whenever it has moved
        glm::dvec3 centre;  ///< of a sphere around it, m, world
        double radius;      ///< m
    };
    const std::vector<Moving>& moving() const { return moving_; }  ///< ascending

private:
    Moving at_pose(uint32_t placement, const glm::dmat4& world) const;

    const gpu_scene::GpuScene& scene_;
    std::vector<bool> moves_;  // per node
    std::vector<glm::dmat4> world_;
    std::vector<uint32_t> still_;
    std::vector<Moving> moving_;
    uint64_t version_ = 0;
};

}  // namespace vesper::render
