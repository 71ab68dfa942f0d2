#include "rays/opacity.h"

#include <algorithm>
#include <cmath>

namespace vesper::rays {
namespace {

/// A place on an axis of a texture in texels, within the texture (repeated or mirrored: within one turn).
double turned(double place, uint32_t size, scene::Wrap wrap) {
    if (wrap == scene::Wrap::Clamp) return std::clamp(place, 0.0, 1.0) * size;
    const double turn = wrap == scene::Wrap::Mirror ? 2 : 1;
    return (place - turn * std::floor(place / turn)) * size;
}

uint32_t texel(double index, uint32_t size, scene::Wrap wrap) {
    const auto last = int64_t(size) - 1;
    int64_t i = int64_t(index);
    if (wrap == scene::Wrap::Clamp) return uint32_t(std::clamp<int64_t>(i, 0, last));
    const int64_t turn = wrap == scene::Wrap::Mirror ? 2 * int64_t(size) : int64_t(size);
    i = (i % turn + turn) % turn;
    return uint32_t(std::min(i <= last ? i : turn - 1 - i, last));
}

double alpha_at(const Image& image, const scene::TextureUse& use, glm::dvec2 uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return 1;
    const glm::dvec2 place(turned(uv.x, image.width, use.wrap_u), turned(uv.y, image.height, use.wrap_v));
    const auto code = [&](double x, double y) {
        const size_t column = texel(x, image.width, use.wrap_u), row = texel(y, image.height, use.wrap_v);
        return image.rgba[4 * (row * image.width + column) + 3] / 255.0;
    };
    if (use.nearest) return code(std::floor(place.x), std::floor(place.y));
    const glm::dvec2 corner = glm::floor(place - 0.5), share = place - 0.5 - corner;
    return glm::mix(glm::mix(code(corner.x, corner.y), code(corner.x + 1, corner.y), share.x),
                    glm::mix(code(corner.x, corner.y + 1), code(corner.x + 1, corner.y + 1), share.x), share.y);
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
