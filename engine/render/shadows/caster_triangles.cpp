#include "render/shadows/caster_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "shaders/shadows/caster_triangles.frag.inc"
#include "shaders/shadows/caster_triangles.vert.inc"
#include "shaders/shadows/cull_triangles.comp.inc"
#include "shared/edges.h"

namespace vesper::render {
namespace {

using graph::load, graph::sample, graph::store, graph::update;

constexpr gpu::Shader kCull{"cull_triangles.comp", cull_triangles_comp, cull_triangles_comp_storage};

constexpr VkVertexInputBindingDescription kBuffers[]{{0, sizeof(glm::vec3), VK_VERTEX_INPUT_RATE_VERTEX}};
constexpr VkVertexInputAttributeDescription kAttributes[]{{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}};
constexpr gpu::GraphicsShaders kTriangles{"caster_triangles.frag",
                                          caster_triangles_vert,
                                          caster_triangles_frag,
                                          {},
                                          sizeof(shared::MapQuadrant),
                                          VK_SHADER_STAGE_VERTEX_BIT,
                                          kBuffers,
                                          kAttributes};

// Of a dispatch: what any device has workgroups for.
constexpr size_t kMostRuns = 65535;

}  // namespace

bool has_caster_triangles(const gpu::Device& device, const gpu_scene::GpuScene& scene) {
    return scene.caster_vertex_count() * shared::kTexelsPerVertex <= device.most_texels(sizeof(glm::vec2)) &&
           scene.index_count() <= device.most_texels(sizeof(uint32_t));
}

float map_snap(const gpu::Device& device) {
    return std::ldexp(1.0f, -int(std::min(device.limits().subPixelPrecisionBits, 8u)));
}

void CasterTriangles::add_quadrant(const shared::MapQuadrant& quadrant) { quadrants_.push_back(quadrant); }

uint32_t CasterTriangles::add_rows(const glm::mat4& rows) {
    rows_.emplace_back(rows[0], rows[1], rows[2]);
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

void CasterTriangles::draw(const FrameContext& frame, const Image& image, const ShadowMapScratch& scratch) const {
    std::vector<shared::TriangleRun> runs = runs_;
    std::ranges::stable_sort(runs, {}, &shared::TriangleRun::quadrant);
    CasterTriangles once;  // quadrants, rows and runs of one dispatch
    uint32_t number = 0, triangles = 0, last_rows = 0;
    std::optional<uint32_t> quadrant;
    const auto dispatch_once = [&] {
        once.dispatch(frame, {image.name + "." + std::to_string(number++), image.depth, image.small}, scratch);
        once = {}, quadrant = {}, triangles = 0;
    };
    for (shared::TriangleRun run : runs) {
        if (once.runs_.size() == kMostRuns || triangles + run.triangles > ShadowMapScratch::kMostTriangles)
            dispatch_once();
        const bool begins = quadrant != run.quadrant;
        if (begins) once.quadrants_.push_back(quadrants_[run.quadrant]), once.quadrants_.back().first = triangles;
        if (begins || run.rows != last_rows) once.rows_.push_back(rows_[run.rows]);
        quadrant = run.quadrant, last_rows = run.rows;
        run.rows = uint32_t(once.rows_.size()) - 1, run.quadrant = uint32_t(once.quadrants_.size()) - 1;
        triangles += run.triangles;
        once.runs_.push_back(run);
    }
    if (!once.runs_.empty()) dispatch_once();
}

void CasterTriangles::dispatch(const FrameContext& frame, const Image& image, const ShadowMapScratch& scratch) const {
    graph::FrameGraph& graph = frame.graph;
    const std::string& name = image.name;
    const graph::Resource kept = scratch.triangles, draws = scratch.draws;
    std::vector<VkDrawIndirectCommand> none(quadrants_.size());
    for (size_t i = 0; i < none.size(); ++i) none[i] = {0, 1, 3 * quadrants_[i].first, 0};
    graph.copy("clear shadow draws", graph.upload("empty shadow draws" + name, none), draws,
               {{0, 0, none.size() * sizeof(VkDrawIndirectCommand)}});
    graph.dispatch(
        "cull shadow triangles",
        frame.kernels.get(kCull,
                          {frame.lockstep() ? 8u : 64u, std::bit_cast<uint32_t>(map_snap(frame.kernels.device()))}),
        {sample(scratch.vertices), sample(scratch.indices), load(graph.upload("shadow rows" + name, rows_)),
         load(graph.upload("shadow runs" + name, runs_)), load(graph.upload("shadow quadrants" + name, quadrants_)),
         update(draws), store(kept), update(image.small)},
        graph::Groups{uint32_t(runs_.size()), 1, 1});
    graph.raster(
        "shadow triangles",
        {{kept, graph::Access::Vertices}, {draws, graph::Access::Arguments}, {image.depth, graph::Access::DepthTarget}},
        [&pipelines = frame.pipelines, kept, draws, quadrants = quadrants_](const graph::Recording& recording) {
            const VkCommandBuffer commands = recording.commands();
            const gpu::GraphicsPipeline& pipeline = pipelines.get(kTriangles, {.targets = {}, .depth = kDepthFormat});
            const VkBuffer buffer = recording.buffer(kept);
            const VkDeviceSize offset = recording.offset(kept);
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline());
            vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &offset);
            vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
            vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
            for (size_t i = 0; i < quadrants.size(); ++i) {
                vkCmdPushConstants(commands, pipeline.layout(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof quadrants[i],
                                   &quadrants[i]);
                vkCmdDrawIndirect(commands, recording.buffer(draws),
                                  recording.offset(draws) + i * sizeof(VkDrawIndirectCommand), 1, 0);
            }
        });
}

void add_caster_triangle_shaders(Digest& digest) {
    for (const std::span<const uint32_t> spirv : {kTriangles.vertex, kTriangles.fragment, kCull.spirv})
        digest.add_list(spirv);
}

}  // namespace vesper::render
