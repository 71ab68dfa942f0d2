#include "render/passes/moving_light.h"

#include "render/pixel_groups.h"
#include "shaders/moving_light/hidden.comp.inc"
#include "shaders/moving_light/patches.comp.inc"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kHidden{"hidden.comp", hidden_comp, hidden_comp_storage},
    kPatches{"patches.comp", patches_comp, patches_comp_storage};

}  // namespace

graph::Resource add_moving_light(const FrameContext& frame, const GBuffer& surfaces, const MovingLight& moving) {
    const gpu_scene::MovingThings& things = moving.things;
    if (things.bodies.empty() && things.patches.empty()) return {};
    const gpu_scene::View& view = frame.view;
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const graph::Resource light =
        frame.graph.transient("moving light", graph::image_shape(VK_FORMAT_R16G16B16A16_SFLOAT, view.extent));
    std::vector<glm::vec4> texels = things.patches;
    if (texels.empty()) texels.emplace_back(0);
    const shared::PatchesPush push{.size = {view.extent.width, view.extent.height},
                                   .ray_scale = view.ray_scale(),
                                   .ray_offset = view.ray_offset(),
                                   .patches = uint32_t(things.patches.size() / shared::kPatchTexels)};
    frame.graph.dispatch("lit patches", frame.kernels.get(kPatches, {groups.width, groups.height, groups.rows}),
                         {load(surfaces.surface), store(light),
                          sample(frame.graph.upload("patches", texels, VK_FORMAT_R32G32B32A32_SFLOAT))},
                         push, cover(view.extent, groups));
    for (const shared::HiddenPush& body : things.bodies) {
        const glm::uvec2 size = body.end_pixel - body.first_pixel;
        frame.graph.dispatch("hidden by bodies", frame.kernels.get(kHidden, {groups.width, groups.height, groups.rows}),
                             {load(surfaces.surface), update(light), sample(moving.volumes)}, body,
                             cover({size.x, size.y}, groups));
    }
    return light;
}

}  // namespace vesper::render
