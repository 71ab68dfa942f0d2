// A scene on the device: geometry, surfaces and their textures. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "base/cache.h"
#include "base/digest.h"
#include "gpu/memory.h"
#include "gpu_scene/caster_cells.h"
#include "gpu_scene/textures.h"
#include "gpu_scene/view.h"
#include "scene/material.h"
#include "scene/tunnel.h"

namespace vesper::scene {
struct Scene;
struct Vertex;
}  // namespace vesper::scene

namespace vesper::gpu_scene {

/// Light that comes from no lamp.
struct AmbientLight {
    glm::vec3 illuminance{0};  ///< on any surface, RGB lx
    glm::vec3 sky{0};          ///< where nothing is drawn, RGB cd/m^2
};

/// Where everything in a scene stands at one moment, and how it is lit.
struct SceneFrame {
    std::vector<glm::dmat4> world;        ///< per node, see world_transforms
    std::vector<float> dimming;           ///< per node, factor on the intensity of its lamp and on the emission of its
                                          ///< mesh, >= 0; empty: 1 everywhere
    std::optional<AmbientLight> ambient;  ///< in place of the scene's
    std::vector<scene::Tunnel> tunnels;   ///< that it does not reach into
    std::vector<bool> moving;  ///< per node, whether it moves in frames like this one; empty: none is known to

    float dimming_of(uint32_t node) const { return dimming.empty() ? 1 : dimming[node]; }
};

/// The static part of a scene, uploaded once. Keeps no reference to the Scene it was made from.
class GpuScene {
public:
    /// Triangles of one material within one mesh.
    struct Part {
        uint32_t material;
        uint32_t first_index, index_count;
        int32_t first_vertex;
        glm::vec3 centre;  ///< of the bounding sphere, m, mesh frame
        float radius;      ///< m
        bool fades;        ///< the opacity of its vertices is less than 1
    };
    /// A mesh drawn at a node.
    struct Placement {
        uint32_t node;
        uint32_t first_part, part_count;
        glm::dmat4 at_rest;  ///< mesh frame to world, where the scene has it
    };
    /// A cell of casters at rest (CasterCell), with its levels as parts: m, from its centre, of no material.
    struct Cell {
        std::vector<PlacedPart> parts;  ///< ascending
        glm::dvec3 centre;              ///< of a sphere around it, m, world
        double radius;                  ///< m
        struct Level {
            double error;  ///< m
            Part part;
        };
        std::vector<Level> levels;  ///< ascending by error
    };
    struct Surface {
        scene::Material material;
        VkDescriptorImageInfo textures[4];  ///< base colour, metallic-roughness, emission, relief
        int32_t mask;                       ///< as shared::Instance::mask
    };

    /// `cache`: keeps cells of casters from run to run; null: nothing does.
    GpuScene(const gpu::Device& device, const scene::Scene& scene, PictureFormat pictures = PictureFormat::Float,
             Cache* cache = nullptr);

    const std::vector<Part>& parts() const { return parts_; }
    const std::vector<Placement>& placements() const { return placements_; }
    const std::vector<Cell>& cells() const { return cells_; }
    const std::vector<Surface>& surfaces() const { return surfaces_; }
    const gpu::OwnedBuffer& vertices() const { return vertices_; }
    const gpu::OwnedBuffer& indices() const { return indices_; }
    /// shared::Facet for each vertex, of the triangle that it is the first of (ProvokingVertices).
    const gpu::OwnedBuffer& facets() const { return facets_; }
    /// shared::Mask of all masked surfaces, and their opacities.
    const gpu::OwnedBuffer& masks() const { return masks_; }
    uint64_t mask_words() const { return mask_words_; }
    /// As shared::Instance::mask.
    float mask_of(const Part& part) const {
        const Surface& surface = surfaces_[part.material];
        const bool masked = surface.material.alpha == scene::Material::Alpha::Mask;
        return masked && part.fades ? -1 : float(surface.mask);
    }
    uint64_t vertex_count() const { return vertex_count_; }                ///< of parts
    uint64_t caster_vertex_count() const { return caster_vertex_count_; }  ///< and, after these, of cells
    uint64_t index_count() const { return index_count_; }                  ///< of both
    /// Depth of the farthest point of any instance along the view axis, m; at least 0.
    float farthest_depth(const SceneFrame& frame, const View& view) const;
    uint64_t triangles() const { return triangles_; }              ///< of all placements
    uint64_t bytes() const { return arena_.bytes(); }              ///< of device memory
    const Digest::Value& occluders() const { return occluders_; }  ///< see occluder_digest()

private:
    void upload_geometry(const gpu::Device& device, const scene::Scene& scene, Cache* cache);
    void add_cells(std::vector<CasterCell> made, std::vector<scene::Vertex>& vertices, std::vector<uint32_t>& indices);
    void place(const scene::Scene& scene);
    void make_surfaces(const gpu::Device& device, const scene::Scene& scene);

    gpu::Arena arena_;
    gpu::OwnedBuffer vertices_, indices_, facets_, masks_;
    uint64_t vertex_count_ = 0, caster_vertex_count_ = 0, index_count_ = 0;
    TextureStore textures_;
    std::vector<Part> parts_;
    std::vector<std::pair<uint32_t, uint32_t>> mesh_parts_;  // first part and number of parts of each mesh
    std::vector<Placement> placements_;
    std::vector<Cell> cells_;
    std::vector<Surface> surfaces_;
    uint64_t triangles_ = 0, mask_words_ = 0;
    Digest::Value occluders_;
};

struct Sphere {
    glm::vec3 centre;  ///< m
    float radius;      ///< m
};
/// A sphere around a part of a mesh after a transform.
Sphere sphere_of(const GpuScene::Part& part, const glm::mat4& transform);
/// Whether a sphere of the view frame may be seen: it reaches beyond the near plane and into the four sides.
bool is_seen(const View& view, const Sphere& sphere);
/// A sphere around a part of a mesh where things are far from the origin.
struct WorldSphere {
    glm::dvec3 centre;  ///< m
    double radius;      ///< m
};
WorldSphere world_sphere_of(const GpuScene::Part& part, const glm::dmat4& to_world);

}  // namespace vesper::gpu_scene
