// Luminance at halving resolutions. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "render/frame_context.h"

namespace vesper::render {

/// Means of luminance, see shared::PyramidPush. Level 0 is the scene image itself and is not stored.
struct Pyramid {
    std::vector<graph::Resource> levels;  ///< levels[k - 1] is level k, rgba32f, up to 1x1 (one level for a 1x1 image)
    std::vector<VkExtent2D> extents;
};

/// `log_epsilon`: 0 for mean logarithms of luminance not below shared::kLuminanceFloor; otherwise cd/m^2 added to
/// luminance.
Pyramid add_pyramid(const FrameContext& frame, graph::Resource scene, float log_epsilon = 0);

/// The pyramid level whose texels are nearest to one degree: round(log2(1 / degrees per pixel)), within the pyramid.
uint32_t foveal_level(const gpu_scene::View& view, const Pyramid& pyramid);

/// A level, or what this function made of one.
struct LevelTexels {
    graph::Resource texels;
    VkExtent2D extent;
};
/// Means of two by two texels that are `apart` texels from each other, at every position, also those half outside.
LevelTexels add_overlapping(const FrameContext& frame, const std::string& name, const LevelTexels& of, uint32_t apart);

}  // namespace vesper::render
