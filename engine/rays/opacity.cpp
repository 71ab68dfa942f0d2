#include "rays/opacity.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rays/texture_lookup.h"

namespace vesper::rays {
namespace {

double alpha_at(const Image& image, const scene::TextureUse& use, glm::dvec2 uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return 1;
    return texture_at({image.width, image.height}, use, uv, [&](size_t i) { return image.rgba[4 * i + 3] / 255.0; });
}

// At the material's cutoff or above.
bool reaches_cutoff(double opacity, const scene::Material& material) {
    return opacity >= double(material.alpha_cutoff) * (1 - 0x1p-11);
}

double least_alpha(const Image& image) {
    uint8_t least = 255;
    for (size_t i = 3; i < image.rgba.size(); i += 4) least = std::min(least, uint8_t(image.rgba[i]));
    return least / 255.0;
}

}  // namespace

double opacity_at(const scene::Scene& scene, const scene::Primitive& primitive, uint32_t triangle, glm::dvec3 weights) {
    const scene::Material& material = scene.materials[primitive.material];
    double opacity = 0;
    glm::dvec2 uv(0);
    for (int k = 0; k < 3; ++k) {
        const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(triangle) + size_t(k)]];
        opacity += weights[k] * vertex.colour[3] / 65535.0;
        uv += weights[k] * glm::dvec2(vertex.uv);
    }
    opacity *= double(material.base_colour.a);
    const uint32_t image = material.base_colour_texture.image;
    return image == scene::kNone ? opacity : opacity * alpha_at(scene.images[image], material.base_colour_texture, uv);
}

bool stops_light(const scene::Scene& scene, const scene::Primitive& primitive, uint32_t triangle, glm::dvec3 weights) {
    return reaches_cutoff(opacity_at(scene, primitive, triangle, weights), scene.materials[primitive.material]);
}

std::vector<bool> have_holes(const scene::Scene& scene) {
    std::vector<std::optional<double>> of_images(scene.images.size());  // their least alpha, of those that matter
    std::vector<double> least;                                          // of each material's opacity, but for corners
    for (const scene::Material& material : scene.materials) {
        double& opacity = least.emplace_back(double(material.base_colour.a));
        const uint32_t image = material.base_colour_texture.image;
        if (material.alpha != scene::Material::Alpha::Mask || image == scene::kNone) continue;
        if (!of_images[image]) of_images[image] = least_alpha(scene.images[image]);
        opacity *= *of_images[image];
    }
    std::vector<bool> holes(least.size());
    for (const scene::Mesh& mesh : scene.meshes)
        for (const scene::Primitive& primitive : mesh.primitives) {
            const uint32_t number = primitive.material;
            const scene::Material& material = scene.materials[number];
            if (material.alpha != scene::Material::Alpha::Mask || holes[number]) continue;
            holes[number] = std::ranges::any_of(primitive.vertices, [&](const scene::Vertex& vertex) {
                return !reaches_cutoff(least[number] * vertex.colour[3] / 65535.0, material);
            });
        }
    return holes;
}

}  // namespace vesper::rays
