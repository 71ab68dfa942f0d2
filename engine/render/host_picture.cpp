#include "render/host_picture.h"

#include <numbers>

#include "base/error.h"
#include "render/formats.h"

namespace vesper::render {

gpu_scene::View view_of(VkExtent2D extent, double vertical_fov, const vision::ImageAngles* angles) {
    if (angles) return gpu_scene::View::of(*angles);
    if (!(vertical_fov > 0 && vertical_fov < std::numbers::pi))
        throw Error("a picture covers more than 0 and less than 180 degrees in height");
    return gpu_scene::View::symmetric(extent, float(vertical_fov), glm::mat4(1));
}

graph::Resource PictureUpload::add(graph::FrameGraph& graph, const HostPicture& picture) {
    const auto [width, height] = picture.extent;
    const uint64_t pixels = uint64_t{width} * height, bytes = pixels * 4 * sizeof(float);
    if (pixels == 0 || (picture.channels != 3 && picture.channels != 4) ||
        picture.values.size() != pixels * picture.channels)
        throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) + " px does not have " +
                    std::to_string(picture.values.size()) + " values");
    if (pixels_.bytes() < bytes) {
        pixels_ = {};  // before the next one takes its memory
        pixels_ =
            gpu::HostBuffer(device_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::HostBuffer::Direction::ToDevice);
    }
    float* to = reinterpret_cast<float*>(pixels_.data());
    for (const float *from = picture.values.data(), *end = from + picture.values.size(); from != end;
         from += picture.channels) {
        for (size_t c = 0; c < 3; ++c) *to++ = picture.scale * from[c];
        *to++ = 1;
    }
    pixels_.flush();
    const graph::Resource scene = graph.transient("scene", graph::image_shape(kSceneFormat, picture.extent));
    graph.copy("picture", graph.external("picture", pixels_.owned(), bytes), scene);
    return scene;
}

}  // namespace vesper::render
