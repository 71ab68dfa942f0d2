#include "rays/opacity.h"

#include <cmath>

#include "rays/texture_lookup.h"

namespace vesper::rays {
namespace {

double alpha_at(const Image& image, const scene::TextureUse& use, glm::dvec2 uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return 1;
    return texture_at({image.width, image.height}, use, uv, [&](size_t i) { return image.rgba[4 * i + 3] / 255.0; });
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
    const double cutoff = double(scene.materials[primitive.material].alpha_cutoff);
    return opacity_at(scene, primitive, triangle, weights) >= cutoff * (1 - 0x1p-11);
}

}  // namespace vesper::rays
