#include "transport/lamp_light.h"

#include <algorithm>
#include <cmath>

#include "photometry/distribution.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "transport/reach.h"

namespace vesper::transport {
namespace {

glm::dvec3 unit(glm::dvec3 v) { return v / std::max(glm::length(v), 1e-300); }

}  // namespace

LampLight::LampLight(const scene::Scene& scene, std::span<const glm::dmat4> world, const rays::RayCaster& rays)
    : scene_(scene), rays_(rays) {
    const std::vector<uint32_t> nodes = scene::nodes_with_lamps(scene);
    std::vector<std::vector<uint32_t>> fixtures = scene::fixture_nodes(scene, nodes, world);
    for (size_t i = 0; i < nodes.size(); ++i) {
        const scene::Lamp& lamp = scene.lamps[scene.nodes[nodes[i]].lamp];
        const glm::dmat4& at = world[nodes[i]];
        // A frame at right angles, whatever the scale: the axis is kept, then the direction to the right.
        const glm::dvec3 back = unit(glm::dvec3(at[2])),
                         right = unit(glm::dvec3(at[0]) - glm::dot(glm::dvec3(at[0]), back) * back);
        double largest = double(lamp.intensity);
        if (lamp.kind == scene::Lamp::Kind::Measured)
            largest *= photometry::largest_intensity(scene.distributions[lamp.distribution]);
        lamps_.push_back({&lamp, glm::dvec3(at[3]), glm::transpose(glm::dmat3(right, glm::cross(back, right), back)),
                          largest, std::move(fixtures[i])});
    }
}

glm::dvec3 LampLight::illuminance(glm::dvec3 point, glm::dvec3 normal, double threshold, uint32_t node) const {
    const glm::dvec3 start = point + skin_at(rays_, point) * normal;
    glm::dvec3 sum(0);
    for (const Placed& lamp : lamps_) {
        const bool directional = lamp.lamp->kind == scene::Lamp::Kind::Directional;
        const glm::dvec3 axis = -glm::dvec3(lamp.to_lamp[0].z, lamp.to_lamp[1].z, lamp.to_lamp[2].z);
        const glm::dvec3 to = directional ? -kReach * axis : lamp.position - point;
        const double distance2 = directional ? 1 : glm::dot(to, to), cosine = glm::dot(normal, to) / glm::length(to);
        if (!(cosine > 0) || !(lamp.largest * cosine >= threshold * distance2)) continue;
        if (node != scene::kNone && std::ranges::binary_search(lamp.fixture, node)) continue;
        const double intensity = directional
                                     ? lamp.largest
                                     : scene::luminous_intensity(*lamp.lamp, scene_.distributions, lamp.to_lamp * -to);
        const double lux = intensity * cosine / distance2;
        if (lux < threshold || lux == 0 || rays_.blocked(start, directional ? start + to : lamp.position, lamp.fixture))
            continue;
        sum += lux * glm::dvec3(lamp.lamp->colour);
    }
    return sum;
}

}  // namespace vesper::transport
