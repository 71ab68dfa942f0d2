#include "render/passes/picture.h"

#include "shaders/picture/picture.comp.inc"
#include "shared/picture.h"

namespace vesper::render {
namespace {

constexpr gpu::Shader kPicture{"picture.comp", picture_comp};

}  // namespace

graph::Resource add_picture(const FrameContext& frame, graph::Resource picture, float scale) {
    const VkExtent2D extent = frame.view.extent;
    const gpu::Kernel& kernel = frame.kernels.get(kPicture);
    const graph::Resource scene = frame.graph.transient("scene", graph::image_shape(kSceneFormat, extent));
    const shared::PicturePush push{{extent.width, extent.height}, scale};
    frame.graph.dispatch("picture", kernel, {graph::sample(picture), graph::store(scene)}, push,
                         graph::cover(extent.width, extent.height, kernel.group[0], kernel.group[1]));
    return scene;
}

}  // namespace vesper::render
