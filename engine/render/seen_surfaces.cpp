#include "render/seen_surfaces.h"

#include <algorithm>
#include <cmath>

#include "gpu/graphics_pipeline.h"
#include "gpu/kernel_cache.h"
#include "graph/executor.h"
#include "photometry/sky_map.h"
#include "render/passes/gbuffer.h"

namespace vesper::render {
std::vector<transport::LitPoint> points_of(std::span<const glm::vec4> surface, const gpu_scene::View& view) {
    const glm::dmat4 world = glm::inverse(glm::dmat4(view.world_to_view));
    const glm::dvec2 scale(view.ray_scale()), offset(view.ray_offset());
    std::vector<transport::LitPoint> points(surface.size());
    for (size_t i = 0; i < surface.size(); ++i) {
        const double depth = double(surface[i].z);
        if (!(depth > 0) || !std::isfinite(depth)) continue;
        const glm::dvec2 centre = glm::dvec2(i % view.extent.width, i / view.extent.width) + 0.5;
        const glm::dvec3 n = photometry::octahedral_direction({surface[i].x, surface[i].y});
        const glm::dvec3 normal = glm::dmat3(world) * n, ray(scale * centre + offset, -1);
        if (!(glm::length(normal) > 0)) continue;                                        // not finite
        const double change = glm::dot(glm::abs(glm::dvec2(n) * scale), glm::dvec2(1));  // of depth over a px, times:
        const double before = kSnapped * change / std::max(std::abs(glm::dot(n, ray)), change);
        const glm::dvec3 at = depth * (1 - kBefore - before) * ray;
        points[i] = {glm::dvec3(world * glm::dvec4(at, 1)), glm::normalize(normal)};
    }
    return points;
}

std::vector<transport::LitPoint> seen_surfaces(gpu::Device& device, const gpu_scene::GpuScene& scene,
                                               const gpu_scene::SceneFrame& poses, const gpu_scene::View& view) {
    const gpu::KernelCache kernels(device);
    const gpu::GraphicsPipelineCache pipelines(device);
    graph::FrameGraph graph;
    const GBuffer surfaces = add_gbuffer({graph, kernels, pipelines, view}, scene, poses);
    const graph::Resource wanted =
        graph.readback("read surfaces", uint64_t(view.extent.width) * view.extent.height * sizeof(glm::vec4));
    graph.copy("fetch surfaces", surfaces.surface, wanted);
    graph::Executor executor(device);
    executor.run(graph);
    return points_of(executor.read_as<glm::vec4>(wanted), view);
}

}  // namespace vesper::render
