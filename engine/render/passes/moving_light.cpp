#include "render/passes/moving_light.h"

#include "render/pixel_groups.h"
#include "shaders/moving_light/moving_light.comp.inc"
#include "shared/moving_light.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store;

constexpr gpu::Shader kMovingLight{"moving_light.comp", moving_light_comp};

}  // namespace

graph::Resource add_moving_light(const FrameContext& frame, const GBuffer& surfaces, const MovingLight& moving) {
    const gpu_scene::MovingThings& things = moving.things;
    if (things.bodies == 0 && things.patches == 0) return {};
    const gpu_scene::View& view = frame.view;
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const graph::Resource light =
        frame.graph.transient("moving light", graph::image_shape(VK_FORMAT_R16G16B16A16_SFLOAT, view.extent));
    const graph::Resource texels = frame.graph.upload("moving things", things.texels, VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource volumes =
        moving.volumes ? moving.volumes
                       : frame.graph.upload("no volumes", std::vector<glm::uvec2>(1), VK_FORMAT_R32G32_UINT);
    const shared::MovingLightPush push{.size = {view.extent.width, view.extent.height},
                                       .ray_scale = view.ray_scale(),
                                       .ray_offset = view.ray_offset(),
                                       .bodies = things.bodies,
                                       .patches = things.patches};
    frame.graph.dispatch("moving light", frame.kernels.get(kMovingLight, {groups.width, groups.height, groups.rows}),
                         {load(surfaces.surface), store(light), sample(texels), sample(volumes)}, push,
                         cover(view.extent, groups));
    return light;
}

}  // namespace vesper::render
