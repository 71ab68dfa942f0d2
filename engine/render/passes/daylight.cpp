#include "render/passes/passes.h"
#include "shared/daylight.h"

namespace vesper {

Resource add_daylight(FrameGraph& graph, const Kernels& kernels, const GBuffer& g, Resource scene, const std::vector<Tunnel>& tunnels,
                      const View& view, glm::vec3 illuminance, float lambert) {
    const glm::mat3 turned(view.world_to_view);
    std::vector<glm::vec4> texels;
    for (const Tunnel& tunnel : tunnels) {
        const glm::vec3 way = tunnel.to - tunnel.from, along = glm::normalize(way);
        const glm::vec3 up = glm::normalize(glm::vec3(0, 1, 0) - along.y * along);
        texels.emplace_back(glm::vec3(view.world_to_view * glm::dvec4(tunnel.from, 1)), glm::length(way));
        texels.emplace_back(turned * along, tunnel.width / 2);
        texels.emplace_back(turned * up, tunnel.height);
    }
    if (texels.empty()) texels.emplace_back(0);
    const shared::DaylightPush push{.size = {view.extent.width, view.extent.height},
                                    .ray_scale = view.ray_scale(),
                                    .ray_offset = view.ray_offset(),
                                    .illuminance = illuminance,
                                    .lambert = lambert,
                                    .tunnels = uint32_t(tunnels.size())};
    graph.dispatch("daylight", kernels.daylight,
                   {load(g.reflectance), load(g.surface), update(scene), sample(graph.upload("tunnels", texels, VK_FORMAT_R32G32B32A32_SFLOAT))}, push,
                   cover(view.extent.width, view.extent.height, kernels.shade_group.width, kernels.shade_group.height * kernels.shade_rows));
    return scene;
}

}  // namespace vesper
