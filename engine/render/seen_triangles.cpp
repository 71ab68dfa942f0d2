#include "render/seen_triangles.h"

#include <algorithm>
#include <vector>

#include "graph/executor.h"
#include "render/passes/gbuffer.h"

namespace vesper::render {

SeenTriangles TriangleCounter::count(const gpu_scene::GpuScene& scene, const gpu_scene::SceneFrame& poses,
                                     const gpu_scene::View& view) const {
    SeenTriangles counts;
    for (const gpu_scene::GpuScene::Placement& placement : scene.placements()) {
        const glm::mat4 to_view = view.from(poses.world[placement.node]);
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
            const gpu_scene::GpuScene::Part& part = scene.parts()[i];
            if (part.index_count == 0 || !gpu_scene::is_seen(view, gpu_scene::sphere_of(part, to_view))) continue;
            ++counts.parts, counts.triangles += part.index_count / 3;
        }
    }
    graph::FrameGraph graph;
    const GBuffer surfaces = add_gbuffer({graph, kernels_, pipelines_, view}, scene, poses);
    const graph::Resource wanted =
        graph.readback("read triangles", uint64_t(view.extent.width) * view.extent.height * sizeof(glm::uvec2));
    graph.copy("fetch triangles", surfaces.triangle, wanted);
    graph::Executor executor(device_);
    executor.run(graph);
    std::vector<uint64_t> seen;  // an instance, 0: none, and a triangle of it
    for (const glm::uvec2& pixel : executor.read_as<glm::uvec2>(wanted))
        if (pixel.x != 0) seen.push_back(uint64_t{pixel.x} << 32 | pixel.y);
    std::ranges::sort(seen);
    uint64_t last = 0;
    for (const uint64_t one : seen) {
        counts.seen_parts += one >> 32 != last >> 32 ? 1 : 0;
        counts.seen_triangles += one != last ? 1 : 0;
        last = one;
    }
    return counts;
}

}  // namespace vesper::render
