#include "render/passes/luminaires.h"

#include "render/silhouettes.h"
#include "shaders/luminaires/luminaires.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kLuminaires{"luminaires.comp", luminaires_comp, luminaires_comp_storage};

}  // namespace

graph::Resource add_luminaires(const FrameContext& frame, graph::Resource scene, graph::Resource surface,
                               const gpu_scene::LuminaireList& list) {
    if (list.tiles.empty()) return scene;
    graph::FrameGraph& graph = frame.graph;
    const VkExtent2D image = frame.view.extent;
    const graph::Resource luminaires = graph.upload("luminaires", list.luminaires, VK_FORMAT_R32G32B32A32_SFLOAT);
    const SilhouetteTexels in_image = upload(graph, list, "luminaire");
    graph.dispatch("luminaires", frame.kernels.get(kLuminaires),
                   {load(surface), update(scene), sample(luminaires), sample(in_image.silhouettes),
                    sample(in_image.tiles), sample(in_image.entries)},
                   shared::LuminairesPush{{image.width, image.height}, in_image.count}, in_image.groups);
    return scene;
}

}  // namespace vesper::render
