#include "transport/emitters.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "base/budget.h"
#include "base/error.h"
#include "base/luminance.h"
#include "base/one_line.h"

namespace vesper::transport {
namespace {

auto key_of(const Emitters::Emitter& e) { return std::tuple(e.node, e.primitive, e.triangle); }

// Of each material, cd/m^2.
std::vector<double> luminances_of(const scene::Scene& scene) {
    std::vector<glm::dvec3> means;
    for (const photometry::LuminancePicture& picture : scene.luminance_pictures)
        means.push_back(photometry::mean_colour(picture));
    std::vector<double> luminances;
    for (const scene::Material& material : scene.materials) {
        const uint32_t picture = material.emission_picture.image;
        const glm::dvec3 factor(material.emission);
        luminances.push_back(luminance(picture == scene::kNone ? factor : factor * means[picture]));
    }
    return luminances;
}

}  // namespace

Emitters::Emitters(const scene::Scene& scene, std::span<const glm::dmat4> world, const Surfaces& surfaces) {
    const std::vector<double> luminances = luminances_of(scene);
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == scene::kNone || surfaces.holds_lamp(node)) continue;
        const scene::Mesh& mesh = scene.meshes[scene.nodes[node].mesh];
        const double front = glm::determinant(glm::dmat3(world[node])) < 0 ? -1 : 1;
        for (uint32_t p = 0; p < mesh.primitives.size(); ++p) {
            const scene::Primitive& primitive = mesh.primitives[p];
            const scene::Material& material = scene.materials[primitive.material];
            const double emitted = luminances[primitive.material];
            if (!(emitted > 0) || material.clear) continue;
            spend(primitive.indices.size() / 3 * 2 * sizeof(Emitter));  // of a vector that grows
            for (uint32_t t = 0; 3 * size_t(t) < primitive.indices.size(); ++t) {
                Emitter e{node, p, t, {}, {}, 0, emitted, material.double_sided};
                for (size_t k = 0; k < 3; ++k) {
                    const scene::Vertex& vertex = primitive.vertices[primitive.indices[3 * size_t(t) + k]];
                    e.corners[k] = glm::dvec3(world[node] * glm::dvec4(vertex.position, 1));
                }
                const glm::dvec3 twice = glm::cross(e.corners[1] - e.corners[0], e.corners[2] - e.corners[0]);
                e.area = 0.5 * glm::length(twice);
                if (!(e.area > 0) || !std::isfinite(e.area)) continue;
                e.outwards = front * twice / (2 * e.area);
                if (list_.size() == kMost)
                    throw Error(one_line(scene.nodes[node].name) + " is one of nodes that emit light with more than " +
                                std::to_string(kMost) + " triangles");
                list_.push_back(e);
            }
        }
    }
}

std::optional<size_t> Emitters::find(const rays::Hit& hit) const {
    const std::tuple key(hit.node, hit.primitive, hit.triangle);
    const auto at = std::ranges::lower_bound(list_, key, {}, key_of);
    if (at == list_.end() || key_of(*at) != key) return std::nullopt;
    return size_t(at - list_.begin());
}

EmitterChoice::EmitterChoice(std::span<const Emitters::Emitter> emitters, glm::dvec3 point, glm::dvec3 normal) {
    double sum = 0;
    ends_.reserve(emitters.size());
    for (const Emitters::Emitter& e : emitters) {
        double above = 0, distance2 = 1e300;
        for (const glm::dvec3 corner : e.corners) {
            const glm::dvec3 to = corner - point;
            above = std::max(above, glm::dot(to, normal) / std::max(glm::length(to), 1e-300));
            distance2 = std::min(distance2, glm::dot(to, to));
        }
        const double facing = glm::dot(e.outwards, point - e.corners[0]);
        // What a large one gives from close by is no more than its luminance.
        if (above > 0 && (facing > 0 || e.double_sided)) sum += e.luminance * above * e.area / (distance2 + e.area);
        ends_.push_back(sum);
    }
}

EmitterChoice::EmitterChoice(std::span<const Emitters::Emitter> emitters) {
    double sum = 0;
    for (const Emitters::Emitter& e : emitters) ends_.push_back(sum += e.luminance * e.area);
}

size_t EmitterChoice::choose(double& share) const {
    const double at = share * ends_.back();
    const auto found = std::min(std::ranges::upper_bound(ends_, at), ends_.end() - 1);
    const size_t emitter = size_t(found - ends_.begin());
    const double begin = emitter == 0 ? 0 : ends_[emitter - 1];
    share = std::clamp((at - begin) / std::max(ends_[emitter] - begin, 1e-300), 0.0, 1.0);
    return emitter;
}

double EmitterChoice::probability(size_t emitter) const {
    return (ends_[emitter] - (emitter == 0 ? 0 : ends_[emitter - 1])) / ends_.back();
}

}  // namespace vesper::transport
