#include "gpu_scene/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/budget.h"
#include "base/one_line.h"
#include "gpu_scene/facets.h"
#include "gpu_scene/intensity_tables.h"
#include "gpu_scene/kept_cells.h"
#include "gpu_scene/occluders.h"
#include "gpu_scene/provoking_vertices.h"
#include "scene/reflectance.h"
#include "shared/edges.h"
#include "shared/retro.h"
#include "shared/shade.h"

namespace vesper::gpu_scene {
namespace {

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

// What a road with a table reflects of light from all sides, and how much of that without sheen.
struct InDiffuse {
    float reflectance, plain;
};

std::vector<InDiffuse> in_diffuse(const scene::Scene& scene) {
    std::vector<InDiffuse> roads;
    for (size_t i = 0; i < scene.reflection_tables.size(); ++i) {
        const photometry::ReflectionTable table = rendered_table(scene, i);
        roads.push_back({reflectance_in_diffuse(table),
                         float(photometry::diffuse_luminance_coefficient(photometry::without_sheen(table)) /
                               photometry::diffuse_luminance_coefficient(table))});
    }
    return roads;
}

// A road with a table as the G-buffer holds it (shared/shade.h): the table says how much it reflects, the texture only
// and colours of vertices only where there is more and where less than in the mean of the surfaces that show it.
scene::Material as_road(const scene::Scene& scene, InDiffuse road, const scene::MaterialUse& use, scene::Material m) {
    const double mean = scene::mean_reflectance(scene, m, use);
    const glm::vec3 colour = mean > 0 ? glm::vec3(glm::dvec3(m.base_colour) / mean) : glm::vec3(1);
    m.base_colour = glm::vec4(colour * road.reflectance, m.base_colour.a);
    m.metallic = shared::kRoadKind - float(m.reflection_table);
    m.roughness = -road.plain;
    m.metallic_roughness_texture = m.normal_texture = {};
    return m;
}

// A retroreflective surface as the G-buffer holds it (shared/retro.h).
scene::Material as_sheet(scene::Material m) {
    m.metallic = shared::kRetroCode + float(m.retroreflector);
    m.roughness = std::min(m.roughness, 0.999f);  // not matt: lamps count by what they give a surface facing them
    m.metallic_roughness_texture = m.normal_texture = {};
    return m;
}

// The facets of all triangles of a primitive, at the vertices that lead them. The primitive's first vertex has the
// number `first`.
void add_facets(const scene::Primitive& primitive, const scene::Material& material, const ProvokingVertices& triangles,
                uint32_t first, std::vector<shared::Facet>& to) {
    to.resize(first + triangles.vertices().size());
    const std::vector<Facet> found = facets(primitive, material);
    for (size_t i = 0; i < found.size(); ++i) {
        const auto& [corners, count, region] = found[i];
        const uint32_t leader = triangles.indices()[3 * i];
        const auto place = uint32_t(std::ranges::find(corners, triangles.vertices()[leader]) - corners.begin());
        for (uint32_t k = 1; k < 4; ++k)
            to[first + leader].others[k - 1] = first + corners[(place + std::min(k, count - 1)) % count];
        to[first + leader].region = region;
    }
}

bool fades(const scene::Primitive& primitive) {
    return std::ranges::any_of(primitive.vertices,
                               [](const scene::Vertex& vertex) { return vertex.colour[3] < 65535; });
}

// A bound of the largest stretch of a linear map, exact where its axes stay at right angles: the square is the largest
// eigenvalue of m^T m, which is within its rows' sums of absolute values (Gershgorin 1931).
float largest_stretch(const glm::mat4& m) {
    const glm::mat3 linear(m);
    const glm::mat3 square = glm::transpose(linear) * linear;
    float largest = 0;
    for (int i = 0; i < 3; ++i)
        largest = std::max(largest, std::abs(square[i].x) + std::abs(square[i].y) + std::abs(square[i].z));
    return std::sqrt(largest) * 1.00001f;  // rounding
}

}  // namespace

Sphere sphere_of(const GpuScene::Part& part, const glm::mat4& m) {
    return {glm::vec3(m * glm::vec4(part.centre, 1)), part.radius * largest_stretch(m)};
}

bool is_seen(const View& view, const Sphere& sphere) {
    const auto [centre, radius] = sphere;
    if (-centre.z + radius < view.near) return false;
    const auto beyond = [z = centre.z, r = radius](float tangent, float across, float sign) {
        return sign * (across + tangent * z) > r * std::sqrt(1 + tangent * tangent);
    };
    return !beyond(view.tangent_high.x, centre.x, 1) && !beyond(view.tangent_low.x, centre.x, -1) &&
           !beyond(view.tangent_high.y, centre.y, 1) && !beyond(view.tangent_low.y, centre.y, -1);
}

WorldSphere world_sphere_of(const GpuScene::Part& part, const glm::dmat4& to_world) {
    const glm::dvec3 centre(to_world * glm::dvec4(part.centre, 1));
    return {centre, double(sphere_of(part, glm::mat4(glm::dmat4(glm::dmat3(to_world)))).radius)};
}

GpuScene::GpuScene(const gpu::Device& device, const scene::Scene& scene, PictureFormat pictures, Cache* cache)
    : arena_(device), textures_(device, arena_, pictures), occluders_(occluder_digest(scene)) {
    const Budget budget("preparing " + (scene.name.empty() ? "the scene" : one_line(scene.name)));
    upload_geometry(device, scene, cache);
    place(scene);
    make_surfaces(device, scene);
}

void GpuScene::upload_geometry(const gpu::Device& device, const scene::Scene& scene, Cache* cache) {
    std::vector<scene::Vertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<shared::Facet> of_triangles;
    for (const scene::Mesh& mesh : scene.meshes) {
        mesh_parts_.emplace_back(uint32_t(parts_.size()), uint32_t(mesh.primitives.size()));
        for (const scene::Primitive& primitive : mesh.primitives) {
            const ProvokingVertices leading(primitive);
            const glm::vec3 centre =
                primitive.bounds.empty() ? glm::vec3(0) : (primitive.bounds.low + primitive.bounds.high) * 0.5f;
            const float radius = primitive.bounds.empty() ? 0 : glm::length(primitive.bounds.high - centre);
            parts_.push_back({primitive.material, uint32_t(indices.size()), uint32_t(primitive.indices.size()),
                              int32_t(vertices.size()), centre, radius, fades(primitive)});
            // On the device, and on the way there.
            spend(2 * (leading.vertices().size() * (sizeof(scene::Vertex) + sizeof(shared::Facet)) +
                       leading.indices().size() * sizeof(uint32_t)));
            add_facets(primitive, scene.materials[primitive.material], leading, uint32_t(vertices.size()),
                       of_triangles);
            for (const uint32_t vertex : leading.vertices()) vertices.push_back(primitive.vertices[vertex]);
            indices.insert(indices.end(), leading.indices().begin(), leading.indices().end());
        }
    }
    if (indices.empty()) return;
    vertex_count_ = vertices.size();
    add_cells(kept_or_made_cells(scene, occluders_, cache), vertices, indices);
    caster_vertex_count_ = vertices.size(), index_count_ = indices.size();
    vertices_ =
        gpu::upload_buffer(device, arena_, bytes_of(vertices), gpu::kTexelUsage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    facets_ = gpu::upload_buffer(device, arena_, bytes_of(of_triangles), gpu::kTexelUsage);
    indices_ =
        gpu::upload_buffer(device, arena_, bytes_of(indices), gpu::kTexelUsage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
}

void GpuScene::add_cells(std::vector<CasterCell> made, std::vector<scene::Vertex>& vertices,
                         std::vector<uint32_t>& indices) {
    for (CasterCell& of : made) {
        spend(2 * (of.vertices.size() * sizeof(scene::Vertex) + of.indices.size() * sizeof(uint32_t)));
        Cell& cell = cells_.emplace_back(Cell{std::move(of.parts), of.origin, of.radius, {}});
        for (const CasterCell::Level& level : of.levels)
            cell.levels.push_back({level.error,
                                   {scene::kNone, uint32_t(indices.size()) + level.first_index, level.index_count,
                                    int32_t(vertices.size()), glm::vec3(0), float(of.radius), false}});
        for (const glm::vec3 position : of.vertices) vertices.push_back({.position = position});
        indices.insert(indices.end(), of.indices.begin(), of.indices.end());
    }
}

void GpuScene::place(const scene::Scene& scene) {
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == scene::kNone) continue;
        const auto [first, count] = mesh_parts_[scene.nodes[i].mesh];
        placements_.push_back({i, first, count, world[i]});
        for (uint32_t p = first; p < first + count; ++p) triangles_ += parts_[p].index_count / 3;
    }
}

void GpuScene::make_surfaces(const gpu::Device& device, const scene::Scene& scene) {
    Masks masks(device.most_texels(sizeof(uint32_t)));
    const std::vector<InDiffuse> roads = in_diffuse(scene);
    const std::vector<scene::MaterialUse> uses =
        roads.empty() ? std::vector<scene::MaterialUse>{} : scene::material_uses(scene);
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const scene::Material& stated = scene.materials[i];
        scene::Material m = stated.reflection_table != scene::kNone
                                ? as_road(scene, roads.at(stated.reflection_table), uses[i], stated)
                            : stated.retroreflector != scene::kNone ? as_sheet(stated)
                                                                    : stated;
        // Opacity passes through half floats, which may be half a step (2^-11 of the value) less than the code said.
        m.alpha_cutoff *= 1 - 0x1p-11f;
        const bool is_masked = m.alpha == scene::Material::Alpha::Mask && m.alpha_cutoff > 0 && m.base_colour.a > 0;
        const float cutoff = is_masked ? m.alpha_cutoff / m.base_colour.a : 0;  // of the texture
        float unit = 1;
        const VkDescriptorImageInfo emission = m.emission_picture.image != scene::kNone
                                                   ? textures_.get_picture(scene, m.emission_picture, unit)
                                                   : textures_.get(scene, m.emission_texture, Decode::Srgb);
        m.emission *= unit;
        surfaces_.push_back({m,
                             {textures_.get(scene, m.base_colour_texture, Decode::Colour, cutoff),
                              textures_.get(scene, m.metallic_roughness_texture, Decode::Data), emission,
                              textures_.get_relief(scene, m.normal_texture, m.normal_scale)},
                             0});
        if (cutoff > 0 && cutoff <= 1 && m.base_colour_texture.image != scene::kNone)
            surfaces_.back().mask =
                masks.add(m.base_colour_texture, cutoff, textures_.opacities(m.base_colour_texture, cutoff));
    }
    textures_.drop_opacities();
    const std::vector<uint32_t> words = masks.words();
    mask_words_ = words.size();
    masks_ = gpu::upload_buffer(device, arena_, bytes_of(words), gpu::kTexelUsage);
}

float GpuScene::farthest_depth(const SceneFrame& frame, const View& view) const {
    float farthest = 0;
    for (const Placement& placement : placements_) {
        const glm::mat4 m = view.from(frame.world[placement.node]);
        for (uint32_t i = placement.first_part; i < placement.first_part + placement.part_count; ++i) {
            const Sphere sphere = sphere_of(parts_[i], m);
            farthest = std::max(farthest, sphere.radius - sphere.centre.z);
        }
    }
    return farthest;
}

}  // namespace vesper::gpu_scene
