#include "render/passes/distance_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>

#include "shaders/distance_map/bound_distances.comp.inc"
#include "shaders/distance_map/distance_map.frag.inc"
#include "shaders/distance_map/distance_map.vert.inc"
#include "shaders/distance_map/store_distances.comp.inc"

namespace vesper::render {
namespace {

using gpu_scene::GpuScene;
using graph::sample, graph::update;

constexpr gpu::Shader kStore{"store_distances.comp", store_distances_comp},
    kBound{"bound_distances.comp", bound_distances_comp};

struct MaskPush {
    float base_opacity, cutoff;
};

constexpr VkDescriptorType kMapTextures[]{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr VkVertexInputBindingDescription kMapBuffers[]{
    {0, sizeof(scene::Vertex), VK_VERTEX_INPUT_RATE_VERTEX},
    {1, sizeof(shared::MapInstance), VK_VERTEX_INPUT_RATE_INSTANCE}};
constexpr VkVertexInputAttributeDescription kMapAttributes[]{
    {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(scene::Vertex, position)},
    {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(scene::Vertex, uv)},
    {2, 0, VK_FORMAT_R16G16B16A16_UNORM, offsetof(scene::Vertex, colour)},
    {3, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, row_x)},
    {4, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, row_y)},
    {5, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, row_z)},
    {6, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::MapInstance, place)},
    {7, 1, VK_FORMAT_R32_SFLOAT, offsetof(shared::MapInstance, y_sign)}};
constexpr gpu::GraphicsShaders kMapShaders{"distance_map.frag", distance_map_vert, distance_map_frag,
                                           kMapTextures,        sizeof(MaskPush),  VK_SHADER_STAGE_FRAGMENT_BIT,
                                           kMapBuffers,         kMapAttributes};

constexpr uint32_t kDrawnSide = 2048;  // texels, of the image that several hemispheres are drawn into

// A hemisphere of a map, and its corner in the image.
struct Hemisphere {
    const MapToDraw* map;
    bool second;
    glm::uvec2 corner;
};

// The place of the n-th region along a curve that fills squares of powers of two one after another (Morton 1966).
glm::uvec2 region_place(uint32_t n) {
    glm::uvec2 place(0);
    for (uint32_t bit = 0; bit < 16; ++bit) place |= glm::uvec2(n >> 2 * bit & 1u, n >> (2 * bit + 1) & 1u) << bit;
    return place * shared::kRegion;
}

// Hemispheres image by image, the largest first, so that each finds a square.
std::vector<std::vector<Hemisphere>> fill_images(std::span<const MapToDraw> maps) {
    std::vector<Hemisphere> all;
    for (const MapToDraw& map : maps)
        for (uint32_t h = 0; h < map.layout.hemispheres && map.layout.side > 0; ++h) all.push_back({&map, h == 1, {}});
    std::ranges::stable_sort(all, std::greater(), [](const Hemisphere& h) { return h.map->layout.side; });
    constexpr uint32_t kRegions = kDrawnSide / shared::kRegion * (kDrawnSide / shared::kRegion);
    std::vector<std::vector<Hemisphere>> images;
    uint32_t filled = kRegions;
    for (Hemisphere& h : all) {
        const uint32_t row = h.map->layout.side / shared::kRegion;
        if (filled + row * row > kRegions) images.emplace_back(), filled = 0;
        h.corner = region_place(filled);
        filled += row * row;
        images.back().push_back(h);
    }
    return images;
}

struct MapPart {
    uint32_t part;
    shared::MapInstance instance;
};

// What stands where a hemisphere sees it.
class Collector {
public:
    Collector(const GpuScene& scene, const gpu_scene::SceneFrame& poses) : scene_(scene), poses_(poses) {
        for (const GpuScene::Placement& placement : scene.placements()) {
            const glm::dmat4& m = poses.world[placement.node];
            for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
                const GpuScene::Part& part = scene.parts()[i];
                const float radius = gpu_scene::sphere_of(part, glm::mat4(glm::dmat4(glm::dmat3(m)))).radius;
                spheres_.push_back({glm::dvec3(m * glm::dvec4(part.centre, 1)), double(radius)});
            }
        }
    }

    void collect(const Hemisphere& h, std::vector<MapPart>& drawn) const {
        const gpu_scene::MapLayout& layout = h.map->layout;
        const gpu_scene::MapFrame& frame = h.map->frame;
        const glm::dvec3 mirror(1, 1, h.second ? -1 : 1);
        const double texel = 2.0 / (double(layout.side) * double(layout.zoom));  // rad, about
        size_t sphere = 0;
        for (uint32_t p = 0; p < scene_.placements().size(); ++p) {
            const GpuScene::Placement& placement = scene_.placements()[p];
            const bool own = std::ranges::binary_search(h.map->fixture, p);
            glm::dmat4 to_map(0);
            bool known = false;
            for (uint32_t i = 0; i < placement.part_count; ++i) {
                const auto& [centre, radius] = spheres_[sphere++];
                const GpuScene::Part& part = scene_.parts()[placement.first_part + i];
                const double away = glm::distance(centre, frame.position);
                if (own || part.index_count == 0 || away - radius > double(layout.range) ||
                    radius < 0.25 * texel * away)
                    continue;
                const glm::dvec3 c = mirror * (frame.rotation * (centre - frame.position));
                if (c.z + radius < 0) continue;
                if (!known) {
                    const glm::dmat4 world =
                        glm::translate(glm::dmat4(1), -frame.position) * poses_.world[placement.node];
                    to_map = glm::dmat4(frame.rotation) * world;
                    known = true;
                }
                add_quadrants(h, placement.first_part + i, c, radius, glm::mat4(to_map), glm::vec3(mirror), drawn);
            }
        }
    }

private:
    struct WorldSphere {
        glm::dvec3 centre;  // m
        double radius;      // m
    };

    static void add_quadrants(const Hemisphere& h, uint32_t part, glm::dvec3 c, double radius, const glm::mat4& to_map,
                              glm::vec3 mirror, std::vector<MapPart>& drawn) {
        const gpu_scene::MapLayout& layout = h.map->layout;
        const double zoom = double(layout.zoom);
        const float scale = float(layout.side) / float(kDrawnSide);
        const glm::vec2 middle = (glm::vec2(h.corner) + 0.5f * float(layout.side)) * (2.0f / float(kDrawnSide)) - 1.0f;
        const glm::mat4 rows = glm::transpose(to_map);
        for (const double sx : {1.0, -1.0})
            for (const double sy : {1.0, -1.0}) {
                // The planes of the quadrant, and those of the square where that is a part of the hemisphere.
                const auto outside = [&](glm::dvec3 inward) {
                    return glm::dot(inward, c) < -radius * glm::length(inward);
                };
                const glm::dvec3 norm(sx, sy, 1), u(zoom, zoom, 0), v(zoom, -zoom, 0);
                if (outside({sx, 0, 0}) || outside({0, sy, 0}) || outside(norm - u) || outside(norm + u) ||
                    outside(norm - v) || outside(norm + v))
                    continue;
                drawn.push_back({part,
                                 {.row_x = rows[0],
                                  .row_y = rows[1],
                                  .row_z = rows[2] * mirror.z,
                                  .place = glm::vec4(scale, middle, float(sx * zoom)),
                                  .y_sign = float(sy)}});
            }
    }

    const GpuScene& scene_;
    const gpu_scene::SceneFrame& poses_;
    std::vector<WorldSphere> spheres_;  // of parts, placement by placement
};

// Instances of one part, drawn at once.
struct MapBatch {
    uint32_t part;
    uint32_t first_instance, instance_count;
};

void record_maps(const graph::Recording& recording, const gpu::Device& device,
                 const gpu::GraphicsPipelineCache& pipelines, const GpuScene& scene, graph::Resource instances,
                 const std::vector<MapBatch>& batches) {
    const VkCommandBuffer commands = recording.commands();
    const VkBuffer buffers[] = {scene.vertices(), recording.buffer(instances)};
    const VkDeviceSize offsets[] = {0, recording.offset(instances)};
    vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, scene.indices(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdSetCullMode(commands, VK_CULL_MODE_NONE);
    vkCmdSetFrontFace(commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
    uint32_t last_material = scene::kNone;
    const gpu::GraphicsPipeline* last_pipeline = nullptr;
    for (const MapBatch& batch : batches) {
        const GpuScene::Part& part = scene.parts()[batch.part];
        const GpuScene::Surface& surface = scene.surfaces()[part.material];
        const scene::Material& m = surface.material;
        const bool mask = m.alpha == scene::Material::Alpha::Mask;
        const gpu::GraphicsPipeline* pipeline =
            &pipelines.get(kMapShaders, {.targets = {}, .depth = kDepthFormat, .constants = {mask ? 1u : 0u}});
        if (pipeline != last_pipeline)
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->pipeline());
        if (part.material != last_material) {
            const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                             .dstBinding = 0,
                                             .descriptorCount = 1,
                                             .descriptorType = kMapTextures[0],
                                             .pImageInfo = &surface.textures[0]};
            device.push_descriptors(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->layout(), 0, 1, &write);
            const MaskPush push{m.base_colour.a, m.alpha_cutoff};
            vkCmdPushConstants(commands, pipeline->layout(), VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
        }
        vkCmdDrawIndexed(commands, part.index_count, batch.instance_count, part.first_index, part.first_vertex,
                         batch.first_instance);
        last_material = part.material, last_pipeline = pipeline;
    }
}

std::vector<shared::MapRegion> regions_of(const std::vector<Hemisphere>& image) {
    std::vector<shared::MapRegion> regions;
    for (const Hemisphere& h : image) {
        const gpu_scene::MapLayout& layout = h.map->layout;
        const uint32_t first = (layout.first + (h.second ? layout.side * layout.side : 0)) / shared::kMapUnit;
        for (uint32_t y = 0; y < layout.side; y += shared::kRegion)
            for (uint32_t x = 0; x < layout.side; x += shared::kRegion)
                regions.push_back({h.corner.x + x, h.corner.y + y, x, y, layout.side, first, layout.zoom, 0});
    }
    return regions;
}

}  // namespace

uint64_t add_distance_maps(const FrameContext& frame, const GpuScene& scene, const gpu_scene::SceneFrame& poses,
                           std::span<const MapToDraw> maps, const MapWords& words) {
    graph::FrameGraph& graph = frame.graph;
    const Collector collector(scene, poses);
    uint64_t triangles = 0;
    uint32_t number = 0;
    for (const std::vector<Hemisphere>& image : fill_images(maps)) {
        const std::string which = " " + std::to_string(number++);
        std::vector<MapPart> drawn;
        for (const Hemisphere& h : image) collector.collect(h, drawn);
        std::ranges::stable_sort(drawn, {}, [&](const MapPart& d) {
            const uint32_t material = scene.parts()[d.part].material;
            return std::tuple(scene.surfaces()[material].material.alpha, material, d.part);
        });
        std::vector<shared::MapInstance> instances;
        std::vector<MapBatch> batches;
        for (const MapPart& d : drawn) {
            if (batches.empty() || batches.back().part != d.part)
                batches.push_back({d.part, uint32_t(instances.size()), 0});
            ++batches.back().instance_count;
            instances.push_back(d.instance);
            triangles += scene.parts()[d.part].index_count / 3;
        }
        if (instances.empty()) instances.emplace_back();  // an upload is never empty

        const graph::Resource placed = graph.upload("map instances" + which, instances);
        const graph::Resource depth =
            graph.transient("drawn maps" + which, graph::image_shape(kDepthFormat, {kDrawnSide, kDrawnSide}));
        graph.raster("distance maps" + which, {{placed, graph::Access::Vertices}, {depth, graph::Access::DepthTarget}},
                     [&device = frame.kernels.device(), &pipelines = frame.pipelines, &scene, placed,
                      batches = std::move(batches)](const graph::Recording& recording) {
                         if (!batches.empty()) record_maps(recording, device, pipelines, scene, placed, batches);
                     });

        const std::vector<shared::MapRegion> regions = regions_of(image);
        const graph::Resource list = graph.upload("map regions" + which, regions, VK_FORMAT_R32G32B32A32_UINT);
        graph.dispatch("store distances" + which, frame.kernels.get(kStore),
                       {sample(depth), sample(list), update(words.distances), update(words.bounds)},
                       graph::Groups{uint32_t(regions.size()), 1, 1});
        const gpu::Kernel& bound = frame.kernels.get(kBound);
        graph.dispatch("bound distances" + which, bound, {sample(list), update(words.bounds)}, uint32_t(regions.size()),
                       graph::cover(uint32_t(regions.size()), 1, bound.group[0], 1));
    }
    return triangles;
}

}  // namespace vesper::render
