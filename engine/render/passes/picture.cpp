#include "render/passes/picture.h"

#include "shaders/picture/picture.comp.inc"
#include "shared/picture.h"

namespace vesper {
namespace {

constexpr Shader kPicture{"picture.comp", picture_comp};

}  // namespace

Resource add_picture(const FrameContext& frame, Resource picture, float scale) {
    const VkExtent2D extent = frame.view.extent;
    const Kernel& kernel = frame.kernels.get(kPicture);
    const Resource scene = frame.graph.transient("scene", image_shape(kSceneFormat, extent));
    const shared::PicturePush push{{extent.width, extent.height}, scale};
    frame.graph.dispatch("picture", kernel, {sample(picture), store(scene)}, push,
                         cover(extent.width, extent.height, kernel.group[0], kernel.group[1]));
    return scene;
}

}  // namespace vesper
