#include "transport/surfaces.h"

#include <cmath>

#include "rays/texture_lookup.h"
#include "scene/fixtures.h"
#include "scene/reflectance.h"

namespace vesper::transport {
namespace {

bool is_finite(glm::dvec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

glm::dvec3 colour_at(const Image& image, const scene::TextureUse& use, glm::dvec2 uv,
                     const std::array<double, 256>& codes) {
    if (!is_finite(uv)) return glm::dvec3(1);
    return rays::texture_at({image.width, image.height}, use, uv, [&](size_t i) {
        return glm::dvec3(codes[image.rgba[4 * i]], codes[image.rgba[4 * i + 1]], codes[image.rgba[4 * i + 2]]);
    });
}

glm::dvec3 picture_at(const photometry::LuminancePicture& picture, const scene::TextureUse& use, glm::dvec2 uv) {
    if (!is_finite(uv)) return glm::dvec3(0);
    return rays::texture_at({picture.width, picture.height}, use, uv, [&](size_t i) {
        return glm::dvec3(picture.rgb[3 * i], picture.rgb[3 * i + 1], picture.rgb[3 * i + 2]);
    });
}

}  // namespace

Surfaces::Surfaces(const scene::Scene& scene, std::span<const glm::dmat4> world)
    : scene_(scene),
      world_(world),
      codes_(scene::linear_codes(scene.transfer)),
      emitted_(scene::linear_codes(scene::Transfer{})),
      holds_lamp_(scene.nodes.size()) {
    for (const std::vector<uint32_t>& fixture : scene::fixture_nodes(scene, scene::nodes_with_lamps(scene), world))
        for (const uint32_t node : fixture) holds_lamp_[node] = true;
}

SurfacePoint Surfaces::at(const rays::Hit& hit, glm::dvec3 from) const {
    const scene::Primitive& primitive = scene_.meshes[scene_.nodes[hit.node].mesh].primitives[hit.primitive];
    const scene::Material& material = scene_.materials[primitive.material];
    const glm::dmat4& to_world = world_[hit.node];
    SurfacePoint point;
    glm::dvec3 corners[3], colour(0);
    glm::dvec2 uv(0);
    for (size_t k = 0; k < 3; ++k) {
        const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(hit.triangle) + k]];
        const double weight = hit.weights[int(k)];
        corners[k] = glm::dvec3(to_world * glm::dvec4(vertex.position, 1));
        point.position += weight * corners[k];
        uv += weight * glm::dvec2(vertex.uv);
        colour += weight / 65535 * glm::dvec3(vertex.colour[0], vertex.colour[1], vertex.colour[2]);
    }
    const glm::dvec3 outwards = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const bool along = glm::dot(outwards, from - point.position) >= 0;
    point.normal = glm::normalize(along ? outwards : -outwards);

    point.reflectance = glm::dvec3(material.base_colour) * colour;
    if (const uint32_t image = material.base_colour_texture.image; image != scene::kNone)
        point.reflectance *= colour_at(scene_.images[image], material.base_colour_texture, uv, codes_);
    const bool front = along != (glm::determinant(glm::dmat3(to_world)) < 0);
    if (holds_lamp_[hit.node] || (!front && !material.double_sided)) return point;
    point.emission = glm::dvec3(material.emission);
    if (point.emission == glm::dvec3(0)) return point;
    if (const uint32_t picture = material.emission_picture.image; picture != scene::kNone)
        point.emission *= picture_at(scene_.luminance_pictures[picture], material.emission_picture, uv);
    else if (const uint32_t image = material.emission_texture.image; image != scene::kNone)
        point.emission *= colour_at(scene_.images[image], material.emission_texture, uv, emitted_);
    return point;
}

}  // namespace vesper::transport
