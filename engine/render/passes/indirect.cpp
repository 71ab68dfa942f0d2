#include "render/passes/indirect.h"

#include "render/pixel_groups.h"
#include "shaders/indirect/illuminance.comp.inc"
#include "shaders/indirect/indirect.comp.inc"
#include "shared/indirect.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kIndirect{"indirect.comp", indirect_comp, indirect_comp_storage};
constexpr gpu::Shader kIlluminance{"illuminance.comp", illuminance_comp};

}  // namespace

graph::Resource add_indirect(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                             const IndirectCells& cells, graph::Resource moving_light, float lambert) {
    if (!cells.texels) return scene;
    const gpu_scene::View& view = frame.view;
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const glm::dmat4 world = glm::inverse(glm::dmat4(view.world_to_view));
    const double per_metre = 1 / cells.grid.size;
    const shared::IndirectPush push{.size = {view.extent.width, view.extent.height},
                                    .ray_scale = view.ray_scale(),
                                    .ray_offset = view.ray_offset(),
                                    .x_axis = glm::vec3(per_metre * glm::dvec3(world[0])),
                                    .y_axis = glm::vec3(per_metre * glm::dvec3(world[1])),
                                    .z_axis = glm::vec3(per_metre * glm::dvec3(world[2])),
                                    .eye = glm::vec3(cells.grid.place(glm::dvec3(world[3]))),
                                    .cubes = glm::vec3(cells.grid.count),
                                    .air_cubes = cells.grid.air_cubes(),
                                    .log2_places = cells.log2_places,
                                    .lambert = lambert,
                                    .sky_above = cells.sky_above,
                                    .sky_below = cells.sky_below};
    // Where nothing moves the image is not looked at; any of its format will do.
    const uint32_t moving = moving_light ? 1 : 0;
    frame.graph.dispatch("indirect", frame.kernels.get(kIndirect, {groups.width, groups.height, groups.rows, moving}),
                         {load(surfaces.reflectance), load(surfaces.surface), update(scene), sample(cells.texels),
                          load(moving ? moving_light : surfaces.reflectance)},
                         push, cover(view.extent, groups));
    return scene;
}

graph::Resource add_illuminance(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                                graph::Resource illuminance, float lambert) {
    if (!illuminance) return scene;
    const gpu_scene::View& view = frame.view;
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const shared::IlluminancePush push{.size = {view.extent.width, view.extent.height},
                                       .ray_scale = view.ray_scale(),
                                       .ray_offset = view.ray_offset(),
                                       .lambert = lambert};
    frame.graph.dispatch("illuminance", frame.kernels.get(kIlluminance, {groups.width, groups.height, groups.rows}),
                         {load(surfaces.reflectance), load(surfaces.surface), update(scene), load(illuminance)}, push,
                         cover(view.extent, groups));
    return scene;
}

}  // namespace vesper::render
