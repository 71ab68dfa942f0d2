#include "render/passes/passes.h"
#include "shared/sky.h"

namespace vesper {

Resource add_sky(FrameGraph& graph, const Kernels& kernels, const GBuffer& g, Resource scene, Resource sky, uint32_t sharp_side,
                 const View& view, float lambert) {
    const glm::mat3 world_from_view = glm::transpose(glm::mat3(view.world_to_view));
    const shared::SkyPush push{.size = {view.extent.width, view.extent.height},
                               .ray_scale = view.ray_scale(),
                               .ray_offset = view.ray_offset(),
                               .right = world_from_view[0],
                               .up = world_from_view[1],
                               .back = world_from_view[2],
                               .lambert = lambert,
                               .sharp_side = sharp_side};
    graph.dispatch("sky", kernels.sky, {load(g.reflectance), load(g.surface), update(scene), sample(sky)}, push,
                   cover(view.extent.width, view.extent.height, kernels.shade_group.width, kernels.shade_group.height * kernels.shade_rows));
    return scene;
}

}  // namespace vesper
