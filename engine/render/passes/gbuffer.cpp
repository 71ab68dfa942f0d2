#include "render/passes/gbuffer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>

#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/small_emitters.h"
#include "scene/scene.h"
#include "shaders/gbuffer/gbuffer.frag.inc"
#include "shaders/gbuffer/gbuffer.vert.inc"
#include "shared/edges.h"
#include "shared/gbuffer.h"

namespace vesper::render {
namespace {

using gpu_scene::GpuScene;

constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kTextures[]{kTexture, kTexture, kTexture, kTexture};
constexpr VkVertexInputBindingDescription kBuffers[]{{0, sizeof(scene::Vertex), VK_VERTEX_INPUT_RATE_VERTEX},
                                                     {1, sizeof(shared::Instance), VK_VERTEX_INPUT_RATE_INSTANCE}};
constexpr VkVertexInputAttributeDescription kAttributes[]{
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(scene::Vertex, position)},
    {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(scene::Vertex, normal)},
    {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(scene::Vertex, uv)},
    {3, 0, VK_FORMAT_R16G16B16A16_UNORM, offsetof(scene::Vertex, colour)},
    {8, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(scene::Vertex, emission_shift)},
    {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_x)},
    {5, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_y)},
    {6, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row_z)},
    {7, 1, VK_FORMAT_R32_SFLOAT, offsetof(shared::Instance, dimming)}};
constexpr VkShaderStageFlags kPushStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr gpu::GraphicsShaders kShaders{
    "gbuffer.frag", gbuffer_vert, gbuffer_frag, kTextures, sizeof(shared::GBufferPush),
    kPushStages,    kBuffers,     kAttributes};

// Bits of a variant of the pipeline. Variants that emit have the largest numbers: they are drawn last, after everything
// that could hide them, and only they write emission, which is cleared to 0.
enum Variant : uint32_t {
    kBaseTexture = 1,
    kMetallicRoughnessTexture = 2,
    kEmissionTexture = 4,
    kMask = 8,
    kNearest = 16,  // times 1, 2 and 4 for the textures above
    kRelief = 128,
    kEmits = 256
};

uint32_t variant_of(const scene::Material& m) {
    uint32_t variant = 0;
    if (m.alpha == scene::Material::Alpha::Mask) variant |= kMask;
    const auto add = [&](const scene::TextureUse& use, uint32_t texture) {
        if (use.image != scene::kNone) variant |= texture | (use.nearest ? kNearest * texture : 0);
    };
    add(m.base_colour_texture, kBaseTexture), add(m.metallic_roughness_texture, kMetallicRoughnessTexture);
    if (m.normal_texture.image != scene::kNone) variant |= kRelief;
    if (m.emission == glm::vec3(0)) return variant;
    add(m.emission_picture.image != scene::kNone ? m.emission_picture : m.emission_texture, kEmissionTexture);
    return variant | kEmits;
}

const gpu::GraphicsPipeline& pipeline_of(const gpu::GraphicsPipelineCache& pipelines, uint32_t variant) {
    return pipelines.get(kShaders, {.targets = {{kReflectanceFormat},
                                                {kSurfaceFormat},
                                                {kEmissionFormat, (variant & kEmits) != 0},
                                                {kTriangleFormat},
                                                {kSlopeFormat}},
                                    .depth = kDepthFormat,
                                    .constants = {variant & kBaseTexture, variant & kMetallicRoughnessTexture,
                                                  variant & kEmissionTexture, variant & kMask, variant / kNearest & 7,
                                                  variant & kRelief}});
}

// How the surfaces of one material are drawn.
struct SurfacePipeline {
    uint32_t variant;
    const gpu::GraphicsPipeline* pipeline;
};

// By material, also of those out of view: none is to be compiled when it comes into view.
std::vector<SurfacePipeline> pipelines_of(const gpu::GraphicsPipelineCache& cache, const GpuScene& scene) {
    std::map<uint32_t, const gpu::GraphicsPipeline*> known;
    std::vector<SurfacePipeline> pipelines;
    for (const GpuScene::Surface& surface : scene.surfaces()) {
        const uint32_t variant = variant_of(surface.material);
        const gpu::GraphicsPipeline*& pipeline = known[variant];
        if (!pipeline) pipeline = &pipeline_of(cache, variant);
        pipelines.push_back({variant, pipeline});
    }
    return pipelines;
}

// Instances of one part, drawn at once.
struct Batch {
    uint32_t part;
    const gpu::GraphicsPipeline* pipeline;
    bool mirrored;
    uint32_t layer;
    uint32_t first_instance, instance_count;
};

struct DrawnPart {
    uint32_t part;
    bool mirrored;
    uint32_t layer;  // see layer_of
    shared::Instance instance;
};

// A rough order from front to back, in shells of distance of a ratio of 1.5, so that few instances are drawn apart:
// what is beside the eye, such as one's own bonnet, hides most; sheets under everything, such as terrain, are hidden by
// most.
uint32_t layer_of(const gpu_scene::Sphere& sphere) {
    constexpr uint32_t kFarthest = 9;
    const float depth = -sphere.centre.z;
    if (sphere.radius > 50) return kFarthest;
    if (depth < sphere.radius + 4) return 0;
    return std::min(kFarthest - 1, uint32_t(1 + std::max(0.0f, std::log(depth / 10) / std::log(1.5f))));
}

std::vector<DrawnPart> cull(const GpuScene& scene, const gpu_scene::SceneFrame& frame, const gpu_scene::View& view,
                            std::span<const uint32_t> without_emission) {
    std::vector<DrawnPart> drawn;
    uint32_t number = 0, mesh = 0;
    for (const GpuScene::Placement& placement : scene.placements()) {
        ++mesh;
        const glm::mat4 m = view.from(frame.world[placement.node]);
        const bool mirrored = glm::determinant(glm::mat3(m)) < 0;
        const glm::mat4 rows = glm::transpose(m);
        const float dimming = frame.dimming_of(placement.node);
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i, ++number) {
            const GpuScene::Part& part = scene.parts()[i];
            const bool apart = !without_emission.empty() && without_emission.front() == number;
            if (apart) without_emission = without_emission.subspan(1);
            const gpu_scene::Sphere sphere = gpu_scene::sphere_of(part, m);
            if (part.index_count == 0 || !gpu_scene::is_seen(view, sphere)) continue;
            drawn.push_back({i,
                             mirrored,
                             layer_of(sphere),
                             {rows[0], rows[1], rows[2], apart ? 0 : dimming, scene.mask_of(part), float(mesh), 0}});
        }
    }
    return drawn;
}

void record_batches(const graph::Recording& recording, const GpuScene& scene, const gpu_scene::View& view,
                    graph::Resource instances, const std::vector<Batch>& batches) {
    const VkCommandBuffer commands = recording.commands();
    const VkBuffer buffers[] = {scene.vertices().get(), recording.buffer(instances)};
    const VkDeviceSize offsets[] = {0, recording.offset(instances)};
    vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, scene.indices().get(), 0, VK_INDEX_TYPE_UINT32);
    const glm::vec2 scale = 2.0f / (view.tangent_high - view.tangent_low);
    const glm::vec2 offset = (view.tangent_high + view.tangent_low) / (view.tangent_high - view.tangent_low);
    uint32_t last_material = scene::kNone;
    const gpu::GraphicsPipeline* last_pipeline = nullptr;
    for (const Batch& batch : batches) {
        const GpuScene::Part& part = scene.parts()[batch.part];
        const GpuScene::Surface& surface = scene.surfaces()[part.material];
        const scene::Material& m = surface.material;
        const VkPipelineLayout layout = batch.pipeline->layout();
        if (batch.pipeline != last_pipeline)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, batch.pipeline->pipeline());
        if (part.material != last_material) {
            VkWriteDescriptorSet writes[std::size(kTextures)];
            for (uint32_t i = 0; i < std::size(kTextures); ++i)
                writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                             .dstBinding = i,
                             .descriptorCount = 1,
                             .descriptorType = kTexture,
                             .pImageInfo = &surface.textures[i]};
            recording.bind(*batch.pipeline, writes);
            // Clip space has y down: view y goes in with its sign turned.
            const shared::GBufferPush push{m.base_colour,    m.emission,          m.alpha_cutoff,        m.metallic,
                                           m.roughness,      {scale.x, -scale.y}, {offset.x, -offset.y}, view.near,
                                           view.ray_scale(), view.ray_offset()};
            vkCmdPushConstants(commands, layout, kPushStages, 0, sizeof push, &push);
        }
        vkCmdSetCullMode(commands, m.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
        vkCmdSetFrontFace(commands, batch.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
        vkCmdDrawIndexed(commands, part.index_count, batch.instance_count, part.first_index, part.first_vertex,
                         batch.first_instance);
        last_material = part.material, last_pipeline = batch.pipeline;
    }
}

static_assert(sizeof(scene::Vertex) == shared::kTexelsPerVertex * sizeof(glm::vec2) &&
              offsetof(scene::Vertex, position) == 0 &&
              offsetof(scene::Vertex, uv) == shared::kUvTexel * sizeof(glm::vec2));

}  // namespace

bool has_facets(const gpu::Device& device, const GpuScene& scene) {
    return scene.vertex_count() > 0 &&
           scene.vertex_count() * shared::kTexelsPerVertex <= device.most_texels(sizeof(glm::vec2)) &&
           scene.vertex_count() <= device.most_texels(sizeof(shared::Facet));
}

GBuffer add_gbuffer(const FrameContext& frame, const GpuScene& scene, const gpu_scene::SceneFrame& poses,
                    std::span<const uint32_t> without_emission) {
    graph::FrameGraph& graph = frame.graph;
    const gpu_scene::View& view = frame.view;
    const std::vector<SurfacePipeline> pipelines = pipelines_of(frame.pipelines, scene);
    std::vector<DrawnPart> drawn = cull(scene, poses, view, without_emission);
    std::stable_sort(drawn.begin(), drawn.end(), [&](const DrawnPart& a, const DrawnPart& b) {
        const auto key = [&](const DrawnPart& d) {
            const uint32_t material = scene.parts()[d.part].material, variant = pipelines[material].variant;
            return std::tuple((variant & kEmits) != 0, d.layer, variant, material, d.part, d.mirrored);
        };
        return key(a) < key(b);
    });
    std::vector<shared::Instance> instances;
    std::vector<Batch> batches;
    for (const DrawnPart& d : drawn) {
        if (batches.empty() || batches.back().part != d.part || batches.back().mirrored != d.mirrored ||
            batches.back().layer != d.layer)
            batches.push_back({d.part, pipelines[scene.parts()[d.part].material].pipeline, d.mirrored, d.layer,
                               uint32_t(instances.size()), 0});
        ++batches.back().instance_count;
        instances.push_back(d.instance);
    }
    if (instances.empty()) instances.emplace_back();  // an upload is never empty

    const graph::Resource placed = graph.upload("instances", instances, VK_FORMAT_R32G32B32A32_SFLOAT);
    GBuffer g{graph.transient("reflectance", graph::image_shape(kReflectanceFormat, view.extent)),
              graph.transient("surface", graph::image_shape(kSurfaceFormat, view.extent)),
              graph.transient("emission", graph::image_shape(kEmissionFormat, view.extent)),
              graph.transient("depth", graph::image_shape(kDepthFormat, view.extent)),
              graph.transient("triangle", graph::image_shape(kTriangleFormat, view.extent)),
              graph.transient("slope", graph::image_shape(kSlopeFormat, view.extent)),
              placed,
              {},
              {},
              graph.external("masks", scene.masks(), scene.mask_words() * sizeof(uint32_t), VK_FORMAT_R32_UINT)};
    if (has_facets(frame.kernels.device(), scene)) {
        const uint64_t count = scene.vertex_count();
        g.vertices =
            graph.external("vertices", scene.vertices(), count * sizeof(scene::Vertex), VK_FORMAT_R32G32_SFLOAT);
        g.facets = graph.external("facets", scene.facets(), count * sizeof(shared::Facet), VK_FORMAT_R32G32B32A32_UINT);
    }
    graph.raster("gbuffer",
                 {{placed, graph::Access::Vertices},
                  {g.reflectance, graph::Access::ColorTarget},
                  {g.surface, graph::Access::ColorTarget},
                  {g.emission, graph::Access::ColorTarget},
                  {g.triangle, graph::Access::ColorTarget},
                  {g.slope, graph::Access::ColorTarget},
                  {g.depth, graph::Access::DepthTarget}},
                 [&scene, view, placed, batches = std::move(batches)](const graph::Recording& recording) {
                     if (!batches.empty()) record_batches(recording, scene, view, placed, batches);
                 });
    return g;
}

}  // namespace vesper::render
