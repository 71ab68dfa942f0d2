#include "render/passes/moving_light.h"

#include "render/pixel_groups.h"
#include "shaders/moving_light/moving_light.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store;

constexpr gpu::Shader kMovingLight{"moving_light.comp", moving_light_comp, moving_light_comp_storage};

}  // namespace

graph::Resource add_moving_light(const FrameContext& frame, const GBuffer& surfaces, const MovingLight& moving) {
    const gpu_scene::MovingThings& things = moving.things;
    if (things.bodies.empty() && things.patches.empty()) return {};
    const gpu_scene::View& view = frame.view;
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const graph::Resource light =
        frame.graph.transient("moving light", graph::image_shape(VK_FORMAT_R16G16B16A16_SFLOAT, view.extent));
    // A buffer has at least one element; a count says what is read.
    std::vector<glm::vec4> patches = things.patches;
    if (patches.empty()) patches.emplace_back(0);
    std::vector<shared::HidingBody> bodies = things.bodies;
    if (bodies.empty()) bodies.emplace_back();
    const graph::Resource hiding = frame.graph.upload("hiding bodies", bodies, VK_FORMAT_R32G32B32A32_UINT);
    const shared::MovingLightPush push{.size = {view.extent.width, view.extent.height},
                                       .ray_scale = view.ray_scale(),
                                       .ray_offset = view.ray_offset(),
                                       .patches = uint32_t(things.patches.size() / shared::kPatchTexels),
                                       .bodies = uint32_t(things.bodies.size())};
    frame.graph.dispatch("moving light", frame.kernels.get(kMovingLight, {groups.width, groups.height, groups.rows}),
                         {load(surfaces.surface), store(light),
                          sample(frame.graph.upload("patches", patches, VK_FORMAT_R32G32B32A32_SFLOAT)), sample(hiding),
                          sample(moving.volumes ? moving.volumes : hiding)},
                         push, cover(view.extent, groups));
    return light;
}

}  // namespace vesper::render
