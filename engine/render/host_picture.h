// Pictures on the host, and how they get to the device. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "eye/scatter.h"
#include "gpu/memory.h"
#include "gpu_scene/view.h"
#include "graph/frame_graph.h"

namespace vesper::render {

/// A picture on the host.
struct HostPicture {
    VkExtent2D extent{};            ///< px
    std::span<const float> values;  ///< RGB (or RGBA, alpha ignored) in linear Rec. 709, rows from the top
    uint32_t channels = 3;          ///< 3 or 4
    float scale = 1;                ///< cd/m^2 per unit
    double vertical_fov = 0.7;      ///< rad, in (0, pi): what angle the picture covers in height
    std::vector<eye::OffscreenLamp> outside =
        {};  ///< lamps that scatter light into it; the picture is seen along -z, y up
    const vision::ImageAngles* angles =
        nullptr;  ///< of its edges, in place of vertical_fov, where the eye's axis is not in its middle
};

/// What a picture covers: `angles`, or so much in height, rad, about the axis of the eye. Throws Error.
gpu_scene::View view_of(VkExtent2D extent, double vertical_fov, const vision::ImageAngles* angles);

/// Memory that pictures go through, one after the other.
class PictureUpload {
public:
    explicit PictureUpload(gpu::Device& device) : device_(device) {}

    /// Declares the picture as scene luminance, rgba32f, cd/m^2 (alpha 1). No earlier frame with one may be under way.
    /// Throws Error if it has no pixels, or not as many values as pixels.
    graph::Resource add(graph::FrameGraph& graph, const HostPicture& picture);

private:
    gpu::Device& device_;
    gpu::HostBuffer pixels_;
};

}  // namespace vesper::render
