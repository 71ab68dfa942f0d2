#include "render/stored_picture.h"

#include <string>

#include "render/formats.h"

namespace vesper::render {
namespace {

constexpr uint64_t kTexel = 16;  // bytes

uint64_t bytes_of(VkExtent2D extent) { return kTexel * extent.width * extent.height; }

}  // namespace

graph::Resource StoredPicture::declare(const gpu::Device& device, graph::FrameGraph& graph,
                                       const gpu_scene::View& view) {
    const uint64_t bytes = bytes_of(view.extent);
    if (!texels_ || bytes_of(view_.extent) != bytes) {
        view_.extent = {0, 0}, texels_ = {};
        arena_.emplace(device);
        texels_ = gpu::make_buffer(device, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        arena_->bind(texels_.get());
    }
    view_ = view;
    return graph.persistent("stored picture", texels_, bytes);
}

void StoredPicture::store(const gpu::Device& device, graph::FrameGraph& graph, graph::Resource image,
                          const gpu_scene::View& view) {
    graph.copy("store picture", image, declare(device, graph, view));
}

graph::Resource StoredPicture::store_middle(const gpu::Device& device, graph::FrameGraph& graph, graph::Resource image,
                                            VkExtent2D whole, const gpu_scene::View& view) {
    const VkExtent2D inner = view.extent;
    if (inner.width == whole.width && inner.height == whole.height) {
        store(device, graph, image, view);
        return image;
    }
    const uint32_t left = (whole.width - inner.width) / 2, top = (whole.height - inner.height) / 2;
    const graph::Resource all = graph.transient("whole picture", graph::buffer_shape(bytes_of(whole)));
    graph.copy("whole picture", image, all);
    std::vector<graph::Region> rows;
    for (uint64_t y = 0; y < inner.height; ++y)
        rows.push_back({kTexel * ((y + top) * whole.width + left), kTexel * y * inner.width, kTexel * inner.width});
    const graph::Resource stored = declare(device, graph, view);
    graph.copy("store picture", all, stored, std::move(rows));
    const graph::Resource middle = graph.transient("middle", graph::image_shape(kSceneFormat, inner));
    graph.copy("middle", stored, middle);
    return middle;
}

graph::Resource StoredPicture::load(graph::FrameGraph& graph, const std::string& name) const {
    const graph::Resource image = graph.transient(name, graph::image_shape(kSceneFormat, view_.extent));
    graph.copy("load " + name, graph.persistent("stored " + name, texels_, bytes_of(view_.extent)), image);
    return image;
}

}  // namespace vesper::render
