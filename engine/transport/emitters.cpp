#include "transport/emitters.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "base/error.h"
#include "base/luminance.h"

namespace vesper::transport {
namespace {

auto key_of(const Emitters::Emitter& e) { return std::tuple(e.node, e.primitive, e.triangle); }

double luminance_of(const scene::Scene& scene, const scene::Material& material) {
    const glm::dvec3 factor(material.emission);
    const uint32_t picture = material.emission_picture.image;
    return luminance(picture == scene::kNone ? factor
                                             : factor * photometry::mean_colour(scene.luminance_pictures[picture]));
}

}  // namespace

Emitters::Emitters(const scene::Scene& scene, std::span<const glm::dmat4> world, const Surfaces& surfaces) {
    for (uint32_t node = 0; node < scene.nodes.size(); ++node) {
        if (scene.nodes[node].mesh == scene::kNone || surfaces.holds_lamp(node)) continue;
        const scene::Mesh& mesh = scene.meshes[scene.nodes[node].mesh];
        const double front = glm::determinant(glm::dmat3(world[node])) > 0 ? 1 : -1;
        for (uint32_t p = 0; p < mesh.primitives.size(); ++p) {
            const scene::Primitive& primitive = mesh.primitives[p];
            const scene::Material& material = scene.materials[primitive.material];
            const double emitted = material.emission == glm::vec3(0) ? 0 : luminance_of(scene, material);
            if (!(emitted > 0) || material.clear) continue;
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
                if (list_.size() == kMost) throw Error("more than " + std::to_string(kMost) + " triangles emit light");
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
