// Decoding of reflectance. SPDX-License-Identifier: MIT
#include "scene/reflectance.h"

#include <algorithm>
#include <cmath>

#include "base/srgb.h"
#include "scene/colour.h"
#include "scene/scene.h"

namespace vesper::scene {

std::array<double, 256> linear_codes(const Transfer& transfer) {
    std::array<double, 256> linear{};
    for (size_t code = 0; code < 256; ++code) {
        const double c = static_cast<double>(code) / 255;
        linear[code] = transfer.kind == Transfer::Kind::Gamma ? std::pow(c, static_cast<double>(transfer.gamma))
                                                              : srgb_to_linear(c);
    }
    return linear;
}

namespace {

/// Texels that a stretch of an axis of texture coordinates covers, and how much of each.
struct Stretch {
    int64_t first = 0;
    std::vector<double> shares;
};

Stretch covered(double low, double high, uint32_t size, Wrap wrap) {
    if (wrap == Wrap::Clamp && low <= high) {  // the outermost texels go on for ever
        const double from = std::clamp(low, -1e6, 1e6) * size, to = std::clamp(high, -1e6, 1e6) * size,
                     last = size - 1.0;
        Stretch stretch{0, std::vector<double>(size, 0.0)};
        if (from == to) stretch.shares[static_cast<size_t>(std::clamp(std::floor(from), 0.0, last))] = 1;
        for (size_t i = 0; i < size && from < to; ++i) {
            const double left = i == 0 ? -HUGE_VAL : static_cast<double>(i),
                         right = i + 1 == size ? HUGE_VAL : static_cast<double>(i) + 1;
            stretch.shares[i] = std::max(0.0, std::min(right, to) - std::max(left, from));
        }
        return stretch;
    }
    if (!(low <= high && high - low < 1)) return {0, std::vector<double>(size, 1.0)};
    const double start = std::floor(low), from = (low - start) * size, to = (high - start) * size;
    Stretch stretch{static_cast<int64_t>(from), {}};
    for (int64_t i = stretch.first; i == stretch.first || static_cast<double>(i) < to; ++i) {
        const double at = static_cast<double>(i);
        stretch.shares.push_back(to > from ? std::min(at + 1, to) - std::max(at, from) : 1);
    }
    stretch.first +=
        static_cast<int64_t>(std::fmod(start, 2)) * size;  // mirrored textures tell even tiles from odd ones
    return stretch;
}

size_t wrapped(int64_t i, int64_t size, Wrap wrap) {
    if (wrap == Wrap::Clamp) return static_cast<size_t>(i);
    const int64_t period = wrap == Wrap::Mirror ? 2 * size : size, m = (i % period + period) % period;
    return static_cast<size_t>(m < size ? m : 2 * size - 1 - m);
}

/// A primitive's own figures, which placing it many times does not change.
MaterialUse use_of(const Primitive& primitive) {
    MaterialUse use{.colour = glm::dvec3(0)};
    for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        glm::dvec3 corner[3], colour(0);
        for (size_t k = 0; k < 3; ++k) {
            const Vertex& vertex = primitive.vertices[primitive.indices[i + k]];
            corner[k] = glm::dvec3(vertex.position);
            colour += glm::dvec3(vertex.colour[0], vertex.colour[1], vertex.colour[2]) / (3 * 65535.0);
            use.uv.add(glm::dvec2(vertex.uv));
        }
        const double area = glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0])) / 2;
        use.area += area, use.colour += area * colour;
    }
    return use;
}

}  // namespace

glm::dvec4 mean_texel(const Image& image, const Transfer& transfer, const TextureUse& use, const UvBox& box) {
    const std::array<double, 256> linear = linear_codes(transfer);
    const Stretch columns = covered(box.low.x, box.high.x, image.width, use.wrap_u),
                  rows = covered(box.low.y, box.high.y, image.height, use.wrap_v);
    std::vector<std::pair<size_t, double>> across;
    for (size_t x = 0; x < columns.shares.size(); ++x)
        across.emplace_back(4 * wrapped(columns.first + static_cast<int64_t>(x), image.width, use.wrap_u),
                            columns.shares[x]);
    glm::dvec4 sum(0);
    double weight = 0;
    for (size_t y = 0; y < rows.shares.size(); ++y) {
        const uint8_t* row = image.rgba.data() +
                             4 * image.width * wrapped(rows.first + static_cast<int64_t>(y), image.height, use.wrap_v);
        glm::dvec4 row_sum(0);
        for (const auto& [at, share] : across) {
            row_sum +=
                share * glm::dvec4(linear[row[at]], linear[row[at + 1]], linear[row[at + 2]], row[at + 3] / 255.0);
            weight += share * rows.shares[y];
        }
        sum += rows.shares[y] * row_sum;
    }
    return weight > 0 ? sum / weight : sum;
}

std::vector<MaterialUse> material_uses(const Scene& scene) {
    std::vector<double> shown(scene.meshes.size());  // m^2 of the world to one of the mesh's, of all nodes together
    const std::vector<glm::dmat4> world = world_transforms(scene, 0);
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].mesh == kNone) continue;
        const glm::dmat3 m(world[i]);
        shown[scene.nodes[i].mesh] += (glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2])) / 3;
    }
    std::vector<MaterialUse> uses(scene.materials.size(), MaterialUse{.colour = glm::dvec3(0)});
    for (size_t i = 0; i < scene.meshes.size(); ++i)
        for (const Primitive& primitive : scene.meshes[i].primitives) {
            const MaterialUse own = use_of(primitive);
            if (!(shown[i] * own.area > 0)) continue;
            MaterialUse& use = uses[primitive.material];
            use.area += shown[i] * own.area, use.colour += shown[i] * own.colour;
            use.uv.add(own.uv.low), use.uv.add(own.uv.high);
        }
    for (MaterialUse& use : uses) use.colour = use.area > 0 ? use.colour / use.area : glm::dvec3(1);
    return uses;
}

double mean_reflectance(const Scene& scene, const Material& material, const MaterialUse& use) {
    const glm::dvec3 colour = glm::dvec3(material.base_colour) * use.colour;
    if (material.base_colour_texture.image == kNone) return luminance(colour);
    const Image& image = scene.images[material.base_colour_texture.image];
    return luminance(colour * glm::dvec3(mean_texel(image, scene.transfer, material.base_colour_texture, use.uv)));
}

}  // namespace vesper::scene
