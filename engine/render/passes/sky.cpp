#include "render/passes/sky.h"

#include "render/pixel_groups.h"
#include "shaders/sky/sky.comp.inc"
#include "shared/sky.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kSky{"sky.comp", sky_comp, sky_comp_storage};

}  // namespace

graph::Resource add_sky(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                        const SkyTexels& sky) {
    if (!sky.texels) return scene;
    const gpu_scene::View& view = frame.view;
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const glm::mat3 world_from_view = glm::transpose(glm::mat3(view.world_to_view));
    const shared::SkyPush push{.size = {view.extent.width, view.extent.height},
                               .ray_scale = view.ray_scale(),
                               .ray_offset = view.ray_offset(),
                               .right = world_from_view[0],
                               .up = world_from_view[1],
                               .back = world_from_view[2],
                               .lambert = sky.lambert,
                               .sharp_side = sky.sharp_side};
    frame.graph.dispatch("sky", frame.kernels.get(kSky, {groups.width, groups.height, groups.rows}),
                         {load(surfaces.reflectance), load(surfaces.surface), update(scene), sample(sky.texels)}, push,
                         cover(view.extent, groups));
    return scene;
}

}  // namespace vesper::render
