#include "render/passes/projection.h"

#include "base/error.h"
#include "eye/encoding.h"
#include "shaders/projection/projection.comp.inc"

namespace vesper::render {
namespace {

constexpr gpu::Shader kProjection{"projection.comp", projection_comp};

std::string pixels_text(VkExtent2D extent) {
    return std::to_string(extent.width) + " x " + std::to_string(extent.height) + " px";
}

void check_projection(const FrameContext& frame, const eye::Projection& projection) {
    const auto [width, height] = projection.picture;
    if (width != frame.view.extent.width || height != frame.view.extent.height)
        throw Error("a projection of a picture of " + pixels_text(projection.picture) + " cannot show one of " +
                    pixels_text(frame.view.extent));
    const uint64_t pixels = uint64_t{projection.extent.width} * projection.extent.height;
    if (pixels == 0 || projection.pixels.size() != pixels)
        throw Error("a projection to " + pixels_text(projection.extent) + " does not have " +
                    std::to_string(projection.pixels.size()) + " pixels");
    const uint64_t bytes = pixels * sizeof(shared::ProjectedPixel),
                   most = frame.kernels.device().limits().maxStorageBufferRange;
    if (bytes > most)
        throw Error("a projection to " + pixels_text(projection.extent) + " takes " + std::to_string(bytes) +
                    " bytes of a buffer, more than the device's " + std::to_string(most));
}

}  // namespace

graph::Resource add_projection(const FrameContext& frame, graph::Resource light, const eye::Projection& projection,
                               const ProjectionSettings& settings) {
    check_projection(frame, projection);
    const auto [width, height] = projection.extent;
    const gpu::Kernel& kernel = frame.kernels.get(kProjection, {settings.blue_first});
    const eye::Encoding encoding = eye::make_encoding(settings.display);
    const graph::Resource pixels = frame.graph.upload("projected pixels", projection.pixels);
    const graph::Resource cells =
        frame.graph.upload("projection's code cells", encoding.cells, VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource image =
        frame.graph.transient("projection", graph::image_shape(kDisplayFormat, projection.extent));
    const shared::ProjectionPush push{
        {width, height}, {projection.picture.width, projection.picture.height}, encoding.push};
    frame.graph.dispatch("projection", kernel,
                         {graph::sample(light), graph::load(pixels), graph::sample(cells), graph::store(image)}, push,
                         graph::cover(width, height, kernel.group[0], kernel.group[1]));
    return image;
}

}  // namespace vesper::render
