#include "transport/surfaces.h"

#include <algorithm>
#include <cmath>

#include "rays/opacity.h"
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
      holes_(rays::have_holes(scene)),
      housings_(scene.nodes.size()) {
    const std::vector<uint32_t> lamps = scene::nodes_with_lamps(scene);
    const std::vector<std::vector<uint32_t>> fixtures = scene::fixture_nodes(scene, lamps, world);
    for (size_t i = 0; i < lamps.size(); ++i)
        for (const uint32_t node : fixtures[i])
            housings_[node].push_back({glm::dvec3(world[lamps[i]][3]), scene::housing_reach(scene.nodes[lamps[i]])});
}

bool Surfaces::is_housing(uint32_t node, const std::array<glm::dvec3, 3>& corners) const {
    if (housings_[node].empty()) return false;
    const glm::dvec3 low = glm::min(corners[0], glm::min(corners[1], corners[2])),
                     high = glm::max(corners[0], glm::max(corners[1], corners[2]));
    return std::ranges::any_of(housings_[node], [&](const Housing& housing) {
        return glm::distance(housing.lamp, glm::clamp(housing.lamp, low, high)) <= housing.reach;
    });
}

// What a ray meets, before textures are looked up.
struct Surfaces::Facet {
    const scene::Material& material;
    glm::dvec3 position{0}, normal{0}, colour{0};
    glm::dvec2 uv{0}, emission_uv{0};
    bool front, housing;
};

const scene::Primitive& Surfaces::primitive_of(const rays::Hit& hit) const {
    return scene_.meshes[scene_.nodes[hit.node].mesh].primitives[hit.primitive];
}

Surfaces::Facet Surfaces::facet(const rays::Hit& hit, glm::dvec3 from) const {
    const scene::Primitive& primitive = primitive_of(hit);
    const glm::dmat4& to_world = world_[hit.node];
    Facet facet{.material = scene_.materials[primitive.material], .front = true, .housing = false};
    std::array<glm::dvec3, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
        const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(hit.triangle) + k]];
        const double weight = hit.weights[int(k)];
        corners[k] = glm::dvec3(to_world * glm::dvec4(vertex.position, 1));
        facet.position += weight * corners[k];
        facet.uv += weight * glm::dvec2(vertex.uv);
        facet.emission_uv += weight * glm::dvec2(vertex.emission_uv());
        facet.colour += weight / 65535 * glm::dvec3(vertex.colour[0], vertex.colour[1], vertex.colour[2]);
    }
    const glm::dvec3 outwards = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const bool along = glm::dot(outwards, from - facet.position) >= 0;
    facet.normal = glm::normalize(along ? outwards : -outwards);
    facet.front = along != (glm::determinant(glm::dmat3(to_world)) < 0);
    facet.housing = is_housing(hit.node, corners);
    return facet;
}

glm::dvec3 Surfaces::emission(const Facet& facet) const {
    const scene::Material& material = facet.material;
    if (facet.housing || (!facet.front && !material.double_sided)) return glm::dvec3(0);
    const glm::dvec3 emission(material.emission);
    if (emission == glm::dvec3(0)) return emission;
    if (const uint32_t picture = material.emission_picture.image; picture != scene::kNone)
        return emission * picture_at(scene_.luminance_pictures[picture], material.emission_picture, facet.emission_uv);
    if (const uint32_t image = material.emission_texture.image; image != scene::kNone)
        return emission * colour_at(scene_.images[image], material.emission_texture, facet.emission_uv, emitted_);
    return emission;
}

glm::dvec3 Surfaces::emission(const rays::Hit& hit, glm::dvec3 from) const { return emission(facet(hit, from)); }

bool Surfaces::stops_light(const rays::Hit& hit) const {
    const scene::Primitive& primitive = primitive_of(hit);
    return scene_.materials[primitive.material].alpha != scene::Material::Alpha::Mask ||
           rays::stops_light(scene_, primitive, hit.triangle, hit.weights);
}

bool Surfaces::shows_back(const rays::Hit& hit, glm::dvec3 from) const {
    return !holes_[primitive_of(hit).material] && !facet(hit, from).front;
}

bool Surfaces::is_double_sided(const rays::Hit& hit) const {
    return scene_.materials[primitive_of(hit).material].double_sided;
}

glm::dvec3 Surfaces::reflectance(const Facet& facet) const {
    const glm::dvec3 reflectance = glm::dvec3(facet.material.base_colour) * facet.colour;
    const scene::TextureUse& use = facet.material.base_colour_texture;
    return use.image == scene::kNone ? reflectance
                                     : reflectance * colour_at(scene_.images[use.image], use, facet.uv, codes_);
}

glm::dvec3 Surfaces::reflectance(const rays::Hit& hit) const { return reflectance(facet(hit, glm::dvec3(0))); }

SurfacePoint Surfaces::at(const rays::Hit& hit, glm::dvec3 from) const {
    const Facet met = facet(hit, from);
    return {met.position, met.normal, reflectance(met), emission(met)};
}

SurfacePoint Surfaces::emitted(const rays::Hit& hit, glm::dvec3 from) const {
    const Facet met = facet(hit, from);
    return {met.position, met.normal, glm::dvec3(0), emission(met)};
}

}  // namespace vesper::transport
