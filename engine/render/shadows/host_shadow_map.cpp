#include "render/shadows/host_shadow_map.h"

#include <cmath>
#include <numeric>

#include <glm/gtc/packing.hpp>

#include "base/error.h"
#include "base/one_line.h"
#include "gpu/graphics_pipeline.h"
#include "gpu/kernel_cache.h"
#include "graph/executor.h"
#include "render/shadows/draw_shadow_maps.h"
#include "scene/scene.h"

namespace vesper::render {
namespace {

// Texels of a map, in its norm.
std::vector<float> drawn_norms(gpu::Device& device, const gpu_scene::GpuScene& resident,
                               const gpu_scene::SceneFrame& poses, const ShadowMapToDraw& map) {
    const uint64_t texels = map.layout.texels(), bytes = texels * sizeof(uint16_t);
    const gpu::KernelCache kernels(device);
    const gpu::GraphicsPipelineCache pipelines(device);
    gpu::Arena arena(device);
    const gpu::OwnedBuffer buffer =
        gpu::make_buffer(device, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    arena.bind(buffer.get());
    graph::FrameGraph graph;
    const graph::Resource distances = graph.persistent("map distances", buffer, bytes);
    const FrameContext frame{graph, kernels, pipelines, {}};
    const ShadowMapScratch scratch = add_shadow_map_scratch(frame, resident);
    add_shadow_maps(frame, resident, poses, nullptr, {&map, 1}, distances, scratch);
    const graph::Resource wanted = graph.readback("read distances", bytes);
    graph.copy("fetch distances", distances, wanted);
    graph::Executor executor(device);
    executor.run(graph);
    std::vector<float> norms;
    norms.reserve(texels);
    for (const uint32_t word : executor.read_as<uint32_t>(wanted)) {
        const glm::vec2 two = glm::unpackHalf2x16(word);
        norms.push_back(two.x), norms.push_back(two.y);
    }
    return norms;
}

}  // namespace

glm::dvec3 HostShadowMap::direction(glm::dvec2 uv, bool second_hemisphere) const {
    const glm::dvec2 o = glm::dvec2(uv.x + uv.y, uv.x - uv.y) / (2 * double(layout.zoom));
    const double z = layout.flat ? 1 : 1 - std::abs(o.x) - std::abs(o.y);
    return glm::transpose(frame.rotation) * glm::dvec3(o, second_hemisphere ? -z : z);
}

HostShadowMap host_shadow_map(gpu::Device& device, const scene::Scene& scene, uint32_t node, uint32_t side) {
    const scene::Lamp& lamp = scene.lamps.at(scene.nodes.at(node).lamp);
    const gpu_scene::GpuScene resident(device, scene);
    const ShadowMapPlan plan = shadow_map_plan(scene, resident, {{lamp, node}});
    HostShadowMap made{plan.layouts.at(0), {}, plan.fixtures.at(0).size(), {}};
    if (!(made.layout.range > 0))
        throw Error("lamp '" + one_line(lamp.name) + "' has no shadow map: it " +
                    (lamp.kind == scene::Lamp::Kind::Directional ? "is directional" : "has no intensity"));
    made.layout.side = side;
    const gpu_scene::SceneFrame poses{scene::world_transforms(scene, 0), {}, {}, {}, {}};
    made.frame = map_frame(poses.world[node]);
    std::vector<uint32_t> everything(resident.placements().size());
    std::iota(everything.begin(), everything.end(), 0u);
    made.distances = drawn_norms(device, resident, poses, {made.layout, made.frame, plan.fixtures[0], everything});
    for (size_t i = 0; i < made.distances.size(); ++i) {
        const size_t texel = i % (size_t{side} * side);
        const glm::dvec2 uv = (glm::dvec2(texel % side, texel / side) + 0.5) * (2.0 / side) - 1.0;
        const double norm = double(made.distances[i]);
        made.distances[i] =
            norm < 0.9 * double(shared::kMapFar) ? float(norm * glm::length(made.direction(uv, false))) : 0;
    }
    return made;
}

}  // namespace vesper::render
