#include "render/passes/passes.h"
#include "shared/picture.h"

namespace vesper {

Resource add_picture(FrameGraph& graph, const Kernels& kernels, Resource picture, VkExtent2D extent, float scale) {
    const Resource scene = graph.transient("scene", image_shape(kSceneFormat, extent));
    const shared::PicturePush push{{extent.width, extent.height}, scale};
    graph.dispatch("picture", kernels.picture, {sample(picture), store(scene)}, push, cover(extent.width, extent.height, kernels.picture.group[0], kernels.picture.group[1]));
    return scene;
}

}  // namespace vesper
