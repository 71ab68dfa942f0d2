// A scene as the ray caster of the reference sees it: in the view frame, in double. SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "passes/gbuffer_reference.h"
#include "scene/scene.h"

namespace vesper::test {

/// Linear value of an 8-bit code: Eq. 1 of Petit, Bremond and Vienne, or IEC 61966-2-1.
inline double linear_value(uint8_t code, const scene::Transfer& transfer) {
    const double t = code / 255.0;
    if (transfer.kind == scene::Transfer::Kind::Gamma) return std::pow(t, double(transfer.gamma));
    return t <= 0.04045 ? t / 12.92 : std::pow((t + 0.055) / 1.055, 2.4);
}

/// A texture of the reference. `transfer` null: codes are linear. Opacity always is.
inline std::optional<reference::Texture> texture_of(const scene::Scene& scene, const scene::TextureUse& use,
                                                    const scene::Transfer* transfer) {
    if (use.image == scene::kNone) return std::nullopt;
    const Image& image = scene.images[use.image];
    const auto wrapping = [](scene::Wrap w) {
        return w == scene::Wrap::Repeat   ? reference::Wrapping::Repeat
               : w == scene::Wrap::Mirror ? reference::Wrapping::Mirror
                                          : reference::Wrapping::Clamp;
    };
    reference::Texture t{image.width, image.height, {}, wrapping(use.wrap_u), wrapping(use.wrap_v)};
    for (size_t i = 0; i < image.rgba.size(); i += 4) {
        glm::dvec4 texel;
        for (size_t c = 0; c < 4; ++c)
            texel[int(c)] = transfer && c < 3 ? linear_value(image.rgba[i + c], *transfer) : image.rgba[i + c] / 255.0;
        t.texels.push_back(texel);
    }
    return t;
}

/// A luminance picture as a texture of the reference.
inline std::optional<reference::Texture> picture_of(const scene::Scene& scene, scene::TextureUse use) {
    const photometry::LuminancePicture& picture = scene.luminance_pictures.at(use.image);
    scene::Scene blank;
    blank.images = {{"", 1, 1, {0, 0, 0, 0}}};
    use.image = 0;
    reference::Texture t = *texture_of(blank, use, nullptr);  // wrapping
    t.width = picture.width, t.height = picture.height, t.texels.clear();
    for (size_t i = 0; i < picture.rgb.size(); i += 3)
        t.texels.emplace_back(picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2], 1);
    return t;
}

/// A normal texture as unit vectors; codes 127 and 128 are 0.
inline std::optional<reference::Texture> relief_of(const scene::Scene& scene, const scene::Material& m) {
    std::optional<reference::Texture> t = texture_of(scene, m.normal_texture, nullptr);
    for (glm::dvec4& texel : t->texels) {
        glm::dvec3 n;
        for (int c = 0; c < 3; ++c) {
            const double from_middle = texel[c] * 255 - 127.5;
            n[c] = std::copysign(std::abs(from_middle) - 0.5, from_middle) / 127;
        }
        texel =
            glm::dvec4(glm::normalize(glm::dvec3(m.normal_scale * n.x, m.normal_scale * n.y, std::max(n.z, 1e-3))), 0);
    }
    return t;
}

/// Every triangle of every node, in the order of nodes.
inline reference::Geometry geometry_of(const scene::Scene& scene, const std::vector<glm::dmat4>& world,
                                       const glm::dmat4& world_to_view) {
    reference::Geometry g;
    const scene::Transfer srgb{};
    for (const scene::Material& m : scene.materials) {
        reference::Surface s;
        s.base = glm::dvec4(m.base_colour), s.metallic = m.metallic, s.roughness = m.roughness,
        s.emission = glm::dvec3(m.emission);
        s.base_texture = texture_of(scene, m.base_colour_texture, &scene.transfer);
        s.metallic_roughness_texture = texture_of(scene, m.metallic_roughness_texture, nullptr);
        s.emission_texture = m.emission_picture.image == scene::kNone ? texture_of(scene, m.emission_texture, &srgb)
                                                                      : picture_of(scene, m.emission_picture);
        if (m.normal_texture.image != scene::kNone) s.normal_texture = relief_of(scene, m);
        s.double_sided = m.double_sided;
        s.alpha_cutoff = m.alpha == scene::Material::Alpha::Mask ? m.alpha_cutoff : 0;
        g.surfaces.push_back(s);
    }
    for (size_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].mesh == scene::kNone) continue;
        const glm::dmat4 m = glm::dmat4(world_to_view) * glm::dmat4(world[n]);
        const glm::dmat3 normals = glm::transpose(glm::inverse(glm::dmat3(m)));
        const bool mirrored = glm::determinant(glm::dmat3(m)) < 0;  // glTF 2.0, 3.7.4: the winding turns round
        for (const scene::Primitive& p : scene.meshes[scene.nodes[n].mesh].primitives)
            for (size_t i = 0; i + 2 < p.indices.size(); i += 3) {
                reference::Triangle t{};
                t.surface = p.material;
                for (size_t k = 0; k < 3; ++k) {
                    const scene::Vertex& v = p.vertices[p.indices[i + (mirrored && k > 0 ? 3 - k : k)]];
                    t.position[k] = glm::dvec3(m * glm::dvec4(v.position, 1));
                    t.normal[k] = normals * glm::dvec3(v.normal);  // interpolated as in the mesh's frame, then turned
                    t.uv[k] = glm::dvec2(v.uv);
                    t.colour[k] = glm::dvec4(v.colour[0], v.colour[1], v.colour[2], v.colour[3]) / 65535.0;
                }
                g.triangles.push_back(t);
            }
    }
    return g;
}

/// Adds a mesh of one primitive and the node that carries it.
inline uint32_t add_mesh(scene::Scene& scene, std::vector<scene::Vertex> vertices, std::vector<uint32_t> indices,
                         uint32_t material, scene::Node node = {}) {
    scene::Primitive p;
    p.material = material, p.vertices = std::move(vertices), p.indices = std::move(indices);
    for (const scene::Vertex& v : p.vertices) p.bounds.add(v.position);
    scene.meshes.push_back({"mesh", {p}});
    node.mesh = uint32_t(scene.meshes.size() - 1);
    scene.nodes.push_back(node);
    return node.mesh;
}

/// A rectangle at `corner` with sides `u` and `v`, seen from where u x v points. uv (0, 0) is the upper left: at corner
/// + v.
inline std::vector<scene::Vertex> rectangle(glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
    const glm::vec3 n = glm::normalize(glm::cross(u, v));
    const auto vertex = [&](glm::vec3 p, float s, float t) {
        scene::Vertex x;
        x.position = p, x.normal = n, x.uv = {s, t};
        return x;
    };
    return {vertex(corner, 0, 1), vertex(corner + u, 1, 1), vertex(corner + u + v, 1, 0), vertex(corner + v, 0, 0)};
}
const std::vector<uint32_t> kRectangle{0, 1, 2, 0, 2, 3};

/// A wall of 10 m by 10 m, 10 m in front of the origin, and a lamp of 500 cd there.
inline scene::Scene wall_with_a_lamp() {
    scene::Scene scene;
    scene.materials = {scene::Material{}};
    add_mesh(scene, rectangle({-5, -5, -10}, {10, 0, 0}, {0, 10, 0}), kRectangle, 0);
    scene.lamps = {scene::Lamp{.name = "lamp", .kind = scene::Lamp::Kind::Point, .intensity = 500}};
    scene::Node node;
    node.lamp = 0;
    scene.nodes.push_back(node);
    return scene;
}

}  // namespace vesper::test
