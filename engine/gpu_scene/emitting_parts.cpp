#include "gpu_scene/emitting_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include "base/budget.h"
#include "gpu_scene/facets.h"
#include "rays/texture_lookup.h"
#include "scene/reflectance.h"

namespace vesper::gpu_scene {
namespace {

using glm::dvec2, glm::dvec3;

// Looks up what surfaces emit.
class Emission {
public:
    explicit Emission(const scene::Scene& scene) : scene_(scene), codes_(scene::linear_codes(scene::Transfer{})) {}

    static bool has_texture(const scene::Material& m) {
        return m.emission_picture.image != scene::kNone || m.emission_texture.image != scene::kNone;
    }
    // The means over the quarters of a triangle, RGB cd/m^2.
    std::array<glm::vec3, 4> means(const scene::Primitive& primitive, uint32_t triangle) const {
        const scene::Material& m = scene_.materials[primitive.material];
        std::array<glm::vec3, 4> luminance;
        luminance.fill(m.emission);
        if (!has_texture(m)) return luminance;
        std::array<dvec2, 3> uv;
        for (size_t k = 0; k < 3; ++k)
            uv[k] = primitive.vertices[primitive.indices[3 * size_t(triangle) + k]].emission_uv();
        const auto parts = quarters(uv);
        for (size_t i = 0; i < 4; ++i) luminance[i] *= glm::vec3(mean(m, parts[i]));
        return luminance;
    }

private:
    // Of rows^2 places, each of as much area: four along a texel, as far as they go.
    dvec3 mean(const scene::Material& m, const std::array<dvec2, 3>& uv) const {
        const dvec2 size = size_of(m);
        const double texels = std::max(glm::length(size * (uv[1] - uv[0])), glm::length(size * (uv[2] - uv[0])));
        const int most = looks_ < kMostLooks ? 64 : 6;
        const int rows = std::isfinite(texels) ? int(std::clamp(std::ceil(4 * texels), 6.0, double(most))) : 6;
        looks_ += uint64_t(rows) * uint64_t(rows);
        dvec3 sum(0);
        for (int row = 0; row < rows; ++row)
            for (int i = 0; i < 2 * row + 1; ++i) {  // small triangles: i / 2 along the row, every other one turned
                const double first = (row + (i % 2 ? 1 / 3.0 : 2 / 3.0)) / rows;
                const double second = (i / 2 + (i % 2 ? 2 / 3.0 : 1 / 3.0)) / rows;
                sum += at(m, uv[0] + first * (uv[1] - uv[0]) + second * (uv[2] - uv[1]));
            }
        return sum / double(rows * rows);
    }
    dvec2 size_of(const scene::Material& m) const {
        if (m.emission_picture.image != scene::kNone) {
            const photometry::LuminancePicture& picture = scene_.luminance_pictures[m.emission_picture.image];
            return {picture.width, picture.height};
        }
        return {scene_.images[m.emission_texture.image].width, scene_.images[m.emission_texture.image].height};
    }
    dvec3 at(const scene::Material& m, dvec2 uv) const {
        if (!std::isfinite(uv.x + uv.y)) return dvec3(0);
        if (m.emission_picture.image != scene::kNone) {
            const photometry::LuminancePicture& picture = scene_.luminance_pictures[m.emission_picture.image];
            return rays::texture_at({picture.width, picture.height}, m.emission_picture, uv, [&](size_t i) {
                return dvec3(picture.rgb[3 * i], picture.rgb[3 * i + 1], picture.rgb[3 * i + 2]);
            });
        }
        const Image& image = scene_.images[m.emission_texture.image];
        return rays::texture_at({image.width, image.height}, m.emission_texture, uv, [&](size_t i) {
            return dvec3(codes_[image.rgba[4 * i]], codes_[image.rgba[4 * i + 1]], codes_[image.rgba[4 * i + 2]]);
        });
    }

    static constexpr uint64_t kMostLooks = 5'000'000;  // a second
    const scene::Scene& scene_;
    std::array<double, 256> codes_;
    mutable uint64_t looks_ = 0;
};

// Whether all lie in one plane, to 1 % of the distance between their corners, and face the same way.
bool is_flat(const std::vector<EmittingPart::Triangle>& triangles) {
    const auto& [a, b, c] = triangles.front().corners;
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    for (const EmittingPart::Triangle& triangle : triangles) {
        const auto& [d, e, f] = triangle.corners;
        if (glm::dot(normal, glm::cross(e - d, f - d)) < 0) return false;
        for (const glm::vec3& corner : triangle.corners)
            if (!(std::abs(glm::dot(normal, corner - a)) <= 0.01f * glm::distance(corner, a))) return false;
    }
    return true;
}

std::array<glm::vec3, 3> corners_of(const scene::Primitive& primitive, size_t triangle) {
    std::array<glm::vec3, 3> corners;
    for (size_t k = 0; k < 3; ++k) corners[k] = primitive.vertices[primitive.indices[3 * triangle + k]].position;
    return corners;
}

EmittingPart emitting_part(const scene::Primitive& primitive, const scene::Material& material,
                           const Emission& emission) {
    EmittingPart part{{}, material.double_sided, !Emission::has_texture(material), 0, {}};
    const size_t count = primitive.indices.size() / 3;
    if (material.emission == glm::vec3(0) || material.alpha == scene::Material::Alpha::Mask ||
        count > kMostTrianglesOfSmallEmitter)
        return part;
    for (uint32_t i = 0; i < count; ++i)
        part.triangles.push_back({corners_of(primitive, i), emission.means(primitive, i)});
    if (part.double_sided && count > 0 && !is_flat(part.triangles)) part.triangles.clear();
    return part;
}

// A facet of a mesh and its box.
struct BoxedFacet {
    std::vector<glm::vec3> corners;
    scene::Bounds box;
};

// The facets of a primitive, each once.
std::vector<BoxedFacet> boxed_facets(const scene::Primitive& primitive, const scene::Material& material) {
    std::vector<BoxedFacet> list;
    std::set<std::array<uint32_t, 4>> known;
    for (const Facet& facet : facets(primitive, material)) {
        std::array<uint32_t, 4> sorted = facet.corners;
        std::sort(sorted.begin(), sorted.begin() + facet.count);
        if (!known.insert(sorted).second) continue;
        BoxedFacet& boxed = list.emplace_back();
        for (uint32_t k = 0; k < facet.count; ++k) {
            boxed.corners.push_back(primitive.vertices[facet.corners[k]].position);
            boxed.box.add(boxed.corners.back());
        }
    }
    return list;
}

bool meet(const scene::Bounds& a, const scene::Bounds& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

// Gives the emitting parts of a mesh what is within half their size of their box, of its other parts.
void add_frames(const scene::Scene& scene, const scene::Mesh& mesh, std::span<EmittingPart> parts) {
    const auto emitting =
        size_t(std::ranges::count_if(parts, [](const auto& part) { return !part.triangles.empty(); }));
    size_t triangles = 0;
    for (const scene::Primitive& primitive : mesh.primitives) triangles += primitive.indices.size() / 3;
    if (emitting * (triangles + parts.size()) > kMostLooksOfMesh)
        for (EmittingPart& part : parts) part.triangles.clear();
    if (emitting == 0 || parts.size() == 1) return;
    std::vector<std::optional<std::vector<BoxedFacet>>> known(mesh.primitives.size());
    for (size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].triangles.empty()) continue;
        scene::Bounds box = mesh.primitives[i].bounds;
        parts[i].reach = 0.5f * glm::distance(box.low, box.high);
        box.low -= parts[i].reach, box.high += parts[i].reach;
        for (size_t p = 0; p < mesh.primitives.size(); ++p) {
            const scene::Primitive& other = mesh.primitives[p];
            if (p == i || scene.materials[other.material].alpha == scene::Material::Alpha::Mask ||
                !meet(other.bounds, box))
                continue;
            if (!known[p]) known[p] = boxed_facets(other, scene.materials[other.material]);
            for (const BoxedFacet& facet : *known[p])
                if (meet(facet.box, box)) {
                    spend(sizeof(std::vector<glm::vec3>) + facet.corners.size() * sizeof(glm::vec3));
                    parts[i].frame.push_back(facet.corners);
                }
            if (parts[i].frame.size() <= kMostFacetsOfFrame) continue;
            parts[i].triangles.clear(), parts[i].frame.clear();
            break;
        }
    }
}

}  // namespace

std::vector<EmittingPart> emitting_parts(const scene::Scene& scene) {
    const Emission emission(scene);
    std::vector<EmittingPart> parts;
    for (const scene::Mesh& mesh : scene.meshes)
        for (const scene::Primitive& primitive : mesh.primitives)
            parts.push_back(emitting_part(primitive, scene.materials[primitive.material], emission));
    size_t first = 0;
    for (const scene::Mesh& mesh : scene.meshes) {
        add_frames(scene, mesh, std::span(parts).subspan(first, mesh.primitives.size()));
        first += mesh.primitives.size();
    }
    return parts;
}

}  // namespace vesper::gpu_scene
