#include "render/shadows/draw_clipmaps.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "render/shadows/caster_parts.h"
#include "scene/scene.h"
#include "shaders/shadows/clipmap.frag.inc"
#include "shaders/shadows/clipmap.vert.inc"
#include "shaders/shadows/store_clipmaps.comp.inc"
#include "shared/gbuffer.h"

namespace vesper::render {
namespace {

using gpu_scene::GpuScene;
using graph::sample, graph::update;

constexpr gpu::Shader kStoreLevel{"store_directional.comp", store_clipmaps_comp};

constexpr VkVertexInputBindingDescription kLevelBuffers[]{{0, sizeof(scene::Vertex), VK_VERTEX_INPUT_RATE_VERTEX},
                                                          {1, sizeof(shared::Instance), VK_VERTEX_INPUT_RATE_INSTANCE}};
constexpr VkVertexInputAttributeDescription kLevelAttributes[]{
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(scene::Vertex, position)},
    {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(scene::Vertex, uv)},
    {2, 0, VK_FORMAT_R16G16B16A16_UNORM, offsetof(scene::Vertex, colour)},
    {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_x)},
    {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_y)},
    {5, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_z)}};

constexpr gpu::GraphicsShaders kLevelShaders{"clipmap.vert",  clipmap_vert,     clipmap_frag,
                                             kCasterTextures, sizeof(MaskPush), VK_SHADER_STAGE_FRAGMENT_BIT,
                                             kLevelBuffers,   kLevelAttributes};

// Casters within a level, and their extent along the light, m from its plane.
struct LevelParts {
    std::vector<uint32_t> placements, parts;  // side by side
    double nearest = 0, farthest = 1;
};

LevelParts parts_of(const GpuScene& scene, const gpu_scene::SceneFrame& poses, const LevelToDraw& level,
                    uint32_t side) {
    LevelParts seen;
    double low = 1e300, high = -1e300;
    for (uint32_t p = 0; p < scene.placements().size(); ++p) {
        const GpuScene::Placement& placement = scene.placements()[p];
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
            const GpuScene::Part& part = scene.parts()[i];
            if (part.index_count == 0 || scene.surfaces()[part.material].material.clear) continue;
            const auto [centre, radius] = gpu_scene::world_sphere_of(part, poses.world[placement.node]);
            const glm::dvec3 from = level.rotation * centre - level.middle;
            if (std::max(std::abs(from.x), std::abs(from.y)) > level.half_width + radius ||
                radius < 0.5 * level.half_width / side)
                continue;
            seen.placements.push_back(p), seen.parts.push_back(i);
            low = std::min(low, from.z - radius), high = std::max(high, from.z + radius);
        }
    }
    // Surfaces have depths above 0, of a range that is not empty.
    if (!seen.parts.empty()) seen.nearest = low - 1, seen.farthest = high + 1;
    return seen;
}

// From meshes to the square and the depth of a level.
shared::Instance instance_of(const glm::dmat4& world, const LevelToDraw& level, const LevelParts& seen) {
    const glm::dvec3 origin = glm::transpose(level.rotation) * level.middle;
    const glm::dmat4 to_level = glm::dmat4(level.rotation) * glm::translate(glm::dmat4(1), -origin) * world;
    const double across = 1 / level.half_width, along = 1 / (seen.farthest - seen.nearest);
    glm::dmat4 to_depth(1);
    to_depth[0].x = to_depth[1].y = across;
    to_depth[2].z = -along, to_depth[3].z = seen.farthest * along;
    const glm::mat4 rows = glm::transpose(glm::mat4(to_depth * to_level));
    return {rows[0], rows[1], rows[2]};
}

}  // namespace

graph::Resource add_level_scratch(graph::FrameGraph& graph, uint32_t side) {
    return graph.reserved("drawn level", graph::image_shape(kDepthFormat, {side, side}),
                          {graph::Access::DepthTarget, graph::Access::Sample});
}

void add_clipmaps(const FrameContext& frame, const GpuScene& scene, const gpu_scene::SceneFrame& poses,
                  std::span<const LevelToDraw> levels, uint32_t side, graph::Resource distances,
                  graph::Resource scratch) {
    graph::FrameGraph& graph = frame.graph;
    uint32_t number = 0;
    for (const LevelToDraw& level : levels) {
        const std::string which = " " + std::to_string(number++);
        const LevelParts seen = parts_of(scene, poses, level, side);
        std::vector<shared::Instance> instances;
        std::vector<CasterBatch> batches;
        for (const uint32_t i : order_by_part(seen.parts, scene)) {
            add_to_batches(batches, seen.parts[i], uint32_t(instances.size()));
            instances.push_back(instance_of(poses.world[scene.placements()[seen.placements[i]].node], level, seen));
        }
        if (instances.empty()) instances.emplace_back();  // an upload is never empty

        const graph::Resource placed = graph.upload("clipmap casters" + which, instances);
        graph.raster(
            "clipmap casters", {{placed, graph::Access::Vertices}, {scratch, graph::Access::DepthTarget, {}, true}},
            [&pipelines = frame.pipelines, &scene, placed,
             batches = std::move(batches)](const graph::Recording& recording) {
                record_casters(recording, pipelines, kLevelShaders,
                               {.targets = {}, .depth = kDepthFormat, .constants = {0}}, scene, placed, batches);
            });
        const shared::StoreClipmapPush push{.first = uint32_t(level.first),
                                            .side = side,
                                            .farthest = float(seen.farthest),
                                            .range = float(seen.farthest - seen.nearest)};
        const gpu::Kernel& store = frame.kernels.get(kStoreLevel);
        graph.dispatch("store clipmaps", store, {sample(scratch), update(distances)}, push,
                       graph::cover(side / 2, side, store.group[0], store.group[1]));
    }
}

}  // namespace vesper::render
