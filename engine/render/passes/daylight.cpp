#include "render/passes/daylight.h"

#include "render/pixel_groups.h"
#include "shaders/daylight/daylight.comp.inc"
#include "shared/daylight.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::update;

constexpr gpu::Shader kDaylight{"daylight.comp", daylight_comp, daylight_comp_storage};

}  // namespace

graph::Resource add_daylight(const FrameContext& frame, const GBuffer& surfaces, graph::Resource scene,
                             const DaylightSettings& settings) {
    if (settings.tunnels.empty()) return scene;
    const gpu_scene::View& view = frame.view;
    const PixelGroups groups = pixel_groups(frame.kernels.device());
    const glm::mat3 turned(view.world_to_view);
    std::vector<glm::vec4> texels;
    for (const scene::Tunnel& tunnel : settings.tunnels) {
        const glm::vec3 way = tunnel.to - tunnel.from, along = glm::normalize(way);
        const glm::vec3 up = glm::normalize(glm::vec3(0, 1, 0) - along.y * along);
        texels.emplace_back(glm::vec3(view.world_to_view * glm::dvec4(tunnel.from, 1)), glm::length(way));
        texels.emplace_back(turned * along, tunnel.width / 2);
        texels.emplace_back(turned * up, tunnel.height);
    }
    const shared::DaylightPush push{.size = {view.extent.width, view.extent.height},
                                    .ray_scale = view.ray_scale(),
                                    .ray_offset = view.ray_offset(),
                                    .illuminance = settings.illuminance,
                                    .lambert = settings.lambert,
                                    .tunnels = uint32_t(settings.tunnels.size())};
    const graph::Resource tunnels = frame.graph.upload("tunnels", texels, VK_FORMAT_R32G32B32A32_SFLOAT);
    frame.graph.dispatch("daylight", frame.kernels.get(kDaylight, {groups.width, groups.height, groups.rows}),
                         {load(surfaces.reflectance), load(surfaces.surface), update(scene), sample(tunnels)}, push,
                         cover(view.extent, groups));
    return scene;
}

}  // namespace vesper::render
