#include "render/shadows/caster_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "shaders/shadows/caster_triangles.frag.inc"
#include "shaders/shadows/caster_triangles.vert.inc"
#include "shaders/shadows/cull_triangles.comp.inc"
#include "shared/edges.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kCull{"cull_triangles.comp", cull_triangles_comp, cull_triangles_comp_storage};

constexpr VkVertexInputBindingDescription kBuffers[]{{0, sizeof(shared::LargeCorner), VK_VERTEX_INPUT_RATE_VERTEX}};
constexpr VkVertexInputAttributeDescription kAttributes[]{
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(shared::LargeCorner, position)},
    {1, 0, VK_FORMAT_R32_UINT, offsetof(shared::LargeCorner, quadrant)}};
constexpr gpu::GraphicsShaders kTriangles{
    "caster_triangles.frag", caster_triangles_vert, caster_triangles_frag, kMapBindings, 0, 0, kBuffers, kAttributes};

// Texels: triangles in boxes of that side are drawn one by one; fewer where many wait for the largest of them.
constexpr uint32_t kSmallInLockstep = 32, kSmall = 16;

}  // namespace

bool has_caster_triangles(const gpu::Device& device, const gpu_scene::GpuScene& scene) {
    return scene.caster_vertex_count() * shared::kTexelsPerVertex <= device.most_texels(sizeof(glm::vec2)) &&
           scene.index_count() <= device.most_texels(sizeof(uint32_t));
}

float map_snap(const gpu::Device& device) {
    return std::ldexp(1.0f, -int(std::min(device.limits().subPixelPrecisionBits, 8u)));
}

uint32_t CasterTriangles::add_rows(const glm::mat3x4& rows) {
    rows_.push_back(rows);
    return uint32_t(rows_.size()) - 1;
}

void CasterTriangles::add(const gpu_scene::GpuScene::Part& part, uint32_t rows, uint32_t quadrant) {
    for (uint32_t first = 0; first < part.index_count; first += 3 * shared::kTrianglesOfRun)
        runs_.push_back({.rows = rows,
                         .quadrant = quadrant,
                         .first_index = part.first_index + first,
                         .first_vertex = uint32_t(part.first_vertex),
                         .triangles = std::min((part.index_count - first) / 3, shared::kTrianglesOfRun)});
}

void CasterTriangles::append(const CasterTriangles& others, uint32_t first_quadrant) {
    const uint32_t first_rows = uint32_t(rows_.size());
    rows_.insert(rows_.end(), others.rows_.begin(), others.rows_.end());
    for (shared::TriangleRun run : others.runs_) {
        run.rows += first_rows, run.quadrant += first_quadrant;
        runs_.push_back(run);
    }
}

void CasterTriangles::draw(const FrameContext& frame, const std::string& name, const MapTargets& to,
                           const ShadowMapScratch& scratch) const {
    if (runs_.empty()) return;
    graph::FrameGraph& graph = frame.graph;
    const graph::Resource rows = graph.upload("shadow rows" + name, rows_), large = scratch.large,
                          draws = scratch.draws,
                          nothing = graph.upload("no large shadow casters" + name,
                                                 std::vector<VkDrawIndirectCommand>{{0, 1, 0, 0}});
    const uint32_t lanes = frame.lockstep() ? 8 : 64, small = frame.lockstep() ? kSmallInLockstep : kSmall,
                   snap = std::bit_cast<uint32_t>(map_snap(frame.kernels.device()));
    uint32_t number = 0;
    for (auto begin = runs_.begin(); begin != runs_.end();) {
        auto end = begin;
        for (uint32_t triangles = 0; end != runs_.end() && uint64_t(end - begin) < kMostGroups; ++end)
            if ((triangles += end->triangles) > ShadowMapScratch::kMostTriangles) break;
        const std::vector<shared::TriangleRun> runs(begin, end);
        const graph::Resource list = graph.upload("shadow runs" + name + "." + std::to_string(number++), runs);
        begin = end;
        graph.copy("clear large shadow casters", nothing, draws);
        graph.dispatch("cull shadow triangles", frame.kernels.get(kCull, {lanes, snap, to.over, small}),
                       {sample(scratch.vertices), sample(scratch.indices), load(rows), load(list), load(to.quadrants),
                        update(draws), store(large), update(to.words),
                        sample(scratch.lamps ? scratch.lamps : scratch.vertices), update(to.changed)},
                       graph::Groups{uint32_t(runs.size()), 1, 1});
        graph.raster("large shadow casters",
                     map_uses(to, {{large, graph::Access::Vertices}, {draws, graph::Access::Arguments}}),
                     [&pipelines = frame.pipelines, to, large, draws](const graph::Recording& recording) {
                         const VkCommandBuffer commands = recording.commands();
                         const gpu::GraphicsPipeline& pipeline =
                             pipelines.get(kTriangles, {.targets = {}, .constants = {0, to.over ? 1u : 0u}});
                         set_map_viewport(commands);
                         MapBindings bindings(recording, to);
                         recording.bind(pipeline, bindings.writes());
                         const VkBuffer buffer = recording.buffer(large);
                         const VkDeviceSize offset = recording.offset(large);
                         vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
                         vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline());
                         vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
                         vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
                         vkCmdDrawIndirect(commands, recording.buffer(draws), recording.offset(draws), 1, 0);
                     },
                     {to.side, to.side});
    }
}

void add_caster_triangle_shaders(Digest& digest) {
    for (const std::span<const uint32_t> spirv : {kTriangles.vertex, kTriangles.fragment, kCull.spirv})
        digest.add_list(spirv);
    digest.add_value(kSmall), digest.add_value(kSmallInLockstep);
}

}  // namespace vesper::render
