#include "render/shadows/caster_triangles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

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
    return scene.vertex_count() * shared::kTexelsPerVertex <= device.most_texels(sizeof(glm::vec2)) &&
           scene.index_count() <= device.most_texels(sizeof(uint32_t));
}

float map_snap(const gpu::Device& device) {
    return std::ldexp(1.0f, -int(std::min(device.limits().subPixelPrecisionBits, 8u)));
}

// What one dispatch culls.
struct CasterTriangles::Chunk {
    std::vector<shared::MapRows> rows;
    std::vector<shared::MapQuadrant> quadrants;
    std::vector<shared::TriangleRun> runs;
    uint32_t triangles = 0;

    bool has_room(uint32_t more) const {
        return runs.size() < kMostRuns && triangles + more <= ShadowMapScratch::kMostTriangles;
    }
};

void CasterTriangles::add_quadrant(const shared::MapQuadrant& quadrant) { quadrants_.push_back({quadrant, {}}); }

uint32_t CasterTriangles::add_rows(const glm::mat4& rows) {
    rows_.push_back({rows[0], rows[1], rows[2]});
    return uint32_t(rows_.size()) - 1;
}

void CasterTriangles::add(const gpu_scene::GpuScene::Part& part, uint32_t rows, uint32_t quadrant) {
    for (uint32_t first = 0; first < part.index_count; first += 3 * shared::kTrianglesOfRun)
        quadrants_[quadrant].runs.push_back(
            {.rows = rows,
             .quadrant = 0,  // in its chunk
             .first_index = part.first_index + first,
             .first_vertex = uint32_t(part.first_vertex),
             .triangles = std::min((part.index_count - first) / 3, shared::kTrianglesOfRun)});
}

void CasterTriangles::draw(const FrameContext& frame, const Image& image, const ShadowMapScratch& scratch) const {
    if (rows_.empty()) return;
    Chunk chunk;
    uint32_t number = 0;
    const auto draw_chunk = [&] {
        draw(chunk, frame, {image.name + "." + std::to_string(number++), image.depth, image.small}, scratch);
        chunk = {};
    };
    for (const QuadrantRuns& of : quadrants_) {
        bool begun = false;
        uint32_t last_rows = 0;
        for (shared::TriangleRun run : of.runs) {
            if (!chunk.has_room(run.triangles)) draw_chunk(), begun = false;
            if (!begun) chunk.quadrants.push_back(of.quadrant), chunk.quadrants.back().first = chunk.triangles;
            if (!begun || run.rows != last_rows) chunk.rows.push_back(rows_[run.rows]);
            begun = true;
            last_rows = std::exchange(run.rows, uint32_t(chunk.rows.size()) - 1);
            run.quadrant = uint32_t(chunk.quadrants.size()) - 1;
            chunk.triangles += run.triangles;
            chunk.runs.push_back(run);
        }
    }
    if (!chunk.runs.empty()) draw_chunk();
}

void CasterTriangles::draw(const Chunk& chunk, const FrameContext& frame, const Image& image,
                           const ShadowMapScratch& scratch) const {
    graph::FrameGraph& graph = frame.graph;
    const std::string& name = image.name;
    const graph::Resource kept = scratch.triangles, draws = scratch.draws;
    std::vector<VkDrawIndirectCommand> none(chunk.quadrants.size());
    for (size_t i = 0; i < none.size(); ++i) none[i] = {0, 1, 3 * chunk.quadrants[i].first, 0};
    graph.copy("no map triangles", graph.upload("no triangles" + name, none), draws,
               {{0, 0, none.size() * sizeof(VkDrawIndirectCommand)}});
    graph.dispatch(
        "cull triangles",
        frame.kernels.get(kCull,
                          {frame.lockstep() ? 8u : 64u, std::bit_cast<uint32_t>(map_snap(frame.kernels.device()))}),
        {sample(scratch.vertices), sample(scratch.indices), load(graph.upload("map rows" + name, chunk.rows)),
         load(graph.upload("map runs" + name, chunk.runs)), load(graph.upload("map quadrants" + name, chunk.quadrants)),
         update(draws), store(kept), update(image.small)},
        graph::Groups{uint32_t(chunk.runs.size()), 1, 1});
    graph.raster(
        "map triangles",
        {{kept, graph::Access::Vertices}, {draws, graph::Access::Arguments}, {image.depth, graph::Access::DepthTarget}},
        [&pipelines = frame.pipelines, kept, draws, quadrants = chunk.quadrants](const graph::Recording& recording) {
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
