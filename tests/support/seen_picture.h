// What pixels of a drawn scene see, for the references of edges and small emitters. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "gpu_scene/facets.h"
#include "gpu_scene/provoking_vertices.h"
#include "gpu_scene/textures.h"
#include "gpu_scene/view.h"
#include "passes/edges_reference.h"
#include "passes/shade_reference.h"
#include "shared/gbuffer.h"
#include "support/rooms.h"
#include "support/scene_geometry.h"

namespace vesper::test {

/// The facet that a vertex of the device leads, in its mesh's frame.
struct LedFacet {
    std::vector<glm::dvec3> corners;
    std::vector<glm::dvec2> uv;
    uint32_t region = 0, material = 0;
    bool fades = false;  // opacities of its vertices
};

inline std::vector<LedFacet> facets_on_the_device(const scene::Scene& scene) {
    std::vector<LedFacet> all;
    for (const scene::Mesh& mesh : scene.meshes)
        for (const scene::Primitive& primitive : mesh.primitives) {
            const gpu_scene::ProvokingVertices leading(primitive);
            const std::vector<gpu_scene::Facet> facets =
                gpu_scene::facets(primitive, scene.materials[primitive.material]);
            const size_t first = all.size();
            all.resize(first + leading.vertices().size());
            bool fades = false;
            for (const scene::Vertex& vertex : primitive.vertices) fades = fades || vertex.colour[3] != 65535;
            for (size_t i = 0; i < facets.size(); ++i) {
                LedFacet& led = all[first + leading.indices()[3 * i]];
                led.region = facets[i].region, led.material = primitive.material, led.fades = fades;
                for (uint32_t k = 0; k < facets[i].count; ++k) {
                    const scene::Vertex& vertex = primitive.vertices[facets[i].corners[k]];
                    led.corners.emplace_back(vertex.position), led.uv.emplace_back(vertex.uv);
                }
            }
        }
    return all;
}

/// The mask of a material, if it has one. `longest`: gpu::Device::anisotropy().
inline std::shared_ptr<const reference::Mask> mask_of(const scene::Scene& scene, uint32_t material, double longest) {
    const scene::Material& m = scene.materials[material];
    if (m.alpha != scene::Material::Alpha::Mask || m.base_colour_texture.image == scene::kNone) return nullptr;
    const reference::Texture whole = *texture_of(scene, m.base_colour_texture, nullptr);
    const auto cutoff = float(m.alpha_cutoff * (1 - 0x1p-11f) / m.base_colour.a);
    gpu_scene::Level base{whole.width, whole.height, {}};
    for (const glm::dvec4& texel : whole.texels)
        for (int c = 0; c < 4; ++c) base.rgba.push_back(float(texel[c]));
    auto mask = std::make_shared<reference::Mask>();
    mask->cutoff = double(cutoff), mask->nearest = m.base_colour_texture.nearest, mask->longest = longest;
    for (const gpu_scene::Level& level : gpu_scene::masked_levels(base, cutoff)) {
        reference::Texture& texture = mask->levels.emplace_back(whole);
        texture.width = level.width, texture.height = level.height, texture.texels.clear();
        for (size_t i = 0; i < level.rgba.size(); i += 4) texture.texels.emplace_back(1, 1, 1, level.rgba[i + 3]);
    }
    return mask;
}

/// What its pixels see, from the layers of its G-buffer; `luminance` of each.
inline reference::SeenPicture seen_picture(const scene::Scene& scene, const gpu_scene::View& view,
                                           const std::vector<glm::uvec2>& triangles,
                                           const std::vector<glm::vec4>& surfaces,
                                           const std::vector<shared::Instance>& instances,
                                           const std::vector<glm::vec4>& luminance, double longest) {
    reference::SeenPicture picture{glm::ivec2(view.extent.width, view.extent.height),
                                   glm::dvec2(view.ray_scale()),
                                   glm::dvec2(view.ray_offset()),
                                   {},
                                   {}};
    const std::vector<LedFacet> facets = facets_on_the_device(scene);
    std::vector<std::shared_ptr<const reference::Mask>> masks;
    for (uint32_t i = 0; i < scene.materials.size(); ++i) masks.push_back(mask_of(scene, i, longest));
    for (size_t i = 0; i < triangles.size(); ++i) {
        reference::SeenFacet& facet = picture.facets.emplace_back();
        picture.luminance.emplace_back(glm::vec3(luminance[i]));
        facet.instance = triangles[i].x;
        if (triangles[i].x == 0) continue;
        facet.triangle = triangles[i].y;
        const shared::Instance& instance = instances[triangles[i].x - 1];
        const LedFacet& led = facets.at(triangles[i].y);
        for (const glm::dvec3& corner : led.corners) {
            const glm::dvec4 p(corner, 1);
            facet.corners.emplace_back(glm::dot(glm::dvec4(instance.row_x), p), glm::dot(glm::dvec4(instance.row_y), p),
                                       glm::dot(glm::dvec4(instance.row_z), p));
        }
        const glm::dvec2 middle = glm::dvec2(i % view.extent.width, i / view.extent.width) + 0.5;
        facet.normal = reference::octahedral_decode({surfaces[i].x, surfaces[i].y});
        facet.position = double(surfaces[i].z) * glm::dvec3(picture.scale * middle + picture.offset, -1);
        facet.placement = double(instance.placement), facet.region = led.region, facet.uv = led.uv;
        const bool masked = scene.materials[led.material].alpha == scene::Material::Alpha::Mask;
        if (masked && !led.fades) facet.mask = masks[led.material];
        facet.masked = masked && (led.fades || facet.mask);
    }
    return picture;
}

/// Boxes, sheets and triangles of all sizes and turns before a wall and the sky, some mirrored, some with holes, some
/// beside and behind the eye.
inline scene::Scene clutter(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    scene::Scene scene;
    add_material(scene, 0.5f);
    scene.materials[0].double_sided = true;
    scene.images = {{"", 8, 8, {}}};
    for (int i = 0; i < 64; ++i)
        scene.images[0].rgba.insert(scene.images[0].rgba.end(), {200, 200, 200, uint8_t(random() % 256)});
    add_material(scene, 0.5f);
    scene.materials[1].alpha = scene::Material::Alpha::Mask, scene.materials[1].alpha_cutoff = 0.5f;
    scene.materials[1].base_colour_texture.image = 0, scene.materials[1].double_sided = true;
    add_rectangle(scene, 0, {-30, -30, -40}, {60, 0, 0}, {0, 40, 0});
    add_rectangle(scene, 0, {-30, -3, 20}, {60, 0, 0}, {0, 0, -60});  // a road under the eye, and behind it
    for (int i = 0; i < 30; ++i) {
        const float size = std::pow(10.0f, unit(random));
        const glm::vec3 place(12 * unit(random), 8 * unit(random), -14 + 12 * unit(random));
        if (i % 3 == 0)
            add_rectangle(scene, i % 2, place, size * glm::vec3(unit(random), unit(random), unit(random)),
                          size * glm::vec3(unit(random), unit(random), unit(random)));
        else
            add_box(scene, 0, size * glm::vec3(0.1f, 1, 0.3f), glm::vec3(0));
        for (size_t n = scene.nodes.size() - 6; i % 3 != 0 && n < scene.nodes.size(); ++n)
            scene.nodes[n].translation = place, scene.nodes[n].scale = {i % 2 ? -1.0 : 1.0, 1.0, 1.0};
    }
    for (int i = 0; i < 60; ++i) {
        const float size = 0.5f * std::pow(10.0f, 0.6f * unit(random));
        const glm::vec3 along(unit(random), unit(random), unit(random)), up(unit(random), unit(random), unit(random));
        add_rectangle(scene, 0, {6 * unit(random), 4 * unit(random), -10 + 4 * unit(random)}, size * along, size * up);
        scene.meshes.back().primitives[0].indices = {0, 1, 2};
    }
    for (scene::Mesh& mesh : scene.meshes)
        for (scene::Primitive& p : mesh.primitives)
            for (size_t k = 0; k < p.vertices.size(); ++k) p.vertices[k].uv = {float(k % 2), float(k / 2)};
    return scene;
}

}  // namespace vesper::test
