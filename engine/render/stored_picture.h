// Pictures that stay on the device between frames. SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "gpu/memory.h"
#include "gpu_scene/view.h"
#include "graph/frame_graph.h"

namespace vesper::render {

/// A picture on the device, rgba32f, cd/m^2, that one frame leaves and others find. It must outlive frames that use it.
class StoredPicture {
public:
    /// Of the picture; without pixels before one is stored.
    const gpu_scene::View& view() const { return view_; }
    uint64_t bytes() const { return arena_ ? arena_->bytes() : 0; }

    /// Declares that a frame leaves `image`, of the extent of `view`, here. No frame that uses it may be under way
    /// where the extent changes. Throws Error if the device has no room.
    void store(const gpu::Device& device, graph::FrameGraph& graph, graph::Resource image, const gpu_scene::View& view);
    /// The same of the middle of `image`, of the extent `whole`. Returns that middle as an image.
    graph::Resource store_middle(const gpu::Device& device, graph::FrameGraph& graph, graph::Resource image,
                                 VkExtent2D whole, const gpu_scene::View& view);
    /// Declares the picture as an image.
    graph::Resource load(graph::FrameGraph& graph, const std::string& name) const;

private:
    graph::Resource declare(const gpu::Device& device, graph::FrameGraph& graph, const gpu_scene::View& view);

    gpu_scene::View view_{.extent = {0, 0}};
    std::optional<gpu::Arena> arena_;
    gpu::OwnedBuffer texels_;
};

}  // namespace vesper::render
