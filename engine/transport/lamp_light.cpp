#include "transport/lamp_light.h"

#include <algorithm>
#include <cmath>

#include "photometry/distribution.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "transport/reach.h"

namespace vesper::transport {
LampLight::LampLight(const scene::Scene& scene, std::span<const glm::dmat4> world, const rays::RayCaster& rays)
    : scene_(scene), rays_(rays) {
    const std::vector<uint32_t> nodes = scene::nodes_with_lamps(scene);
    std::vector<std::vector<uint32_t>> fixtures = scene::fixture_nodes(scene, nodes, world);
    for (size_t i = 0; i < nodes.size(); ++i) {
        const scene::Lamp& lamp = scene.lamps[scene.nodes[nodes[i]].lamp];
        const glm::dmat4& at = world[nodes[i]];
        double largest = double(lamp.intensity);
        if (lamp.kind == scene::Lamp::Kind::Measured)
            largest *= photometry::largest_intensity(scene.distributions[lamp.distribution]);
        lamps_.push_back({nodes[i], &lamp, glm::dvec3(at[3]), glm::transpose(scene::lamp_frame(at)), largest,
                          std::move(fixtures[i])});
    }
}

// From a point of a surface.
struct LampLight::Way {
    glm::dvec3 to;     // m; of directional lamps kReach
    double cosine;     // with the normal
    double distance2;  // that it takes light, m^2; directional: 1
    double bound() const { return cosine > 0 ? cosine / distance2 : 0; }
};

LampLight::Way LampLight::way_to(const Placed& lamp, glm::dvec3 point, glm::dvec3 normal) const {
    const bool directional = lamp.lamp->kind == scene::Lamp::Kind::Directional;
    const glm::dvec3 axis = -glm::dvec3(lamp.to_lamp[0].z, lamp.to_lamp[1].z, lamp.to_lamp[2].z);
    const glm::dvec3 to = directional ? -kReach * axis : lamp.position - point;
    return {to, glm::dot(normal, to) / std::max(glm::length(to), 1e-300), directional ? 1 : glm::dot(to, to)};
}

// lx, if nothing stands between.
double LampLight::unshadowed(const Placed& lamp, const Way& way) const {
    const double intensity = lamp.lamp->kind == scene::Lamp::Kind::Directional
                                 ? lamp.largest
                                 : scene::luminous_intensity(*lamp.lamp, scene_.distributions, lamp.to_lamp * -way.to);
    return intensity * way.bound();
}

bool LampLight::blocked(const Placed& lamp, const Way& way, glm::dvec3 point, glm::dvec3 normal) const {
    const glm::dvec3 start = point + skin_at(rays_, point) * normal;
    const bool directional = lamp.lamp->kind == scene::Lamp::Kind::Directional;
    return rays_.blocked(start, directional ? start + way.to : lamp.position, lamp.fixture);
}

glm::dvec3 LampLight::illuminance(glm::dvec3 point, glm::dvec3 normal, double threshold, uint32_t node) const {
    glm::dvec3 sum(0);
    for (const Placed& lamp : lamps_) {
        const Way way = way_to(lamp, point, normal);
        if (!(way.cosine > 0) || !(lamp.largest * way.cosine >= threshold * way.distance2)) continue;
        if (node != scene::kNone && std::ranges::binary_search(lamp.fixture, node)) continue;
        const double lux = unshadowed(lamp, way);
        if (lux < threshold || lux == 0 || blocked(lamp, way, point, normal)) continue;
        sum += lux * glm::dvec3(lamp.lamp->colour);
    }
    return sum;
}

void LampLight::sample(glm::dvec3 point, glm::dvec3 normal, uint32_t node, uint32_t looks, Random& random,
                       std::vector<Share>& shares) const {
    // First by what a lamp may give at most, then, of some, by what they give.
    struct Candidate {
        const Placed* lamp;
        Way way;
        double weight;
    };
    std::vector<Candidate> all;
    double most = 0;
    for (const Placed& lamp : lamps_) {
        const Way way = way_to(lamp, point, normal);
        if (!(lamp.largest * way.bound() > 0)) continue;
        if (node != scene::kNone && std::ranges::binary_search(lamp.fixture, node)) continue;
        all.push_back({&lamp, way, lamp.largest * way.bound()}), most += all.back().weight;
    }
    // The numbers of even steps through the sum of all weights that fall into each.
    const auto systematic = [&random](std::vector<Candidate>& from, double sum, uint32_t steps, auto take) {
        double next = random.next() * sum / steps, at = 0;
        for (Candidate& candidate : from) {
            at += candidate.weight;
            uint32_t times = 0;
            for (; next < at; next += sum / steps) ++times;
            if (times > 0) take(candidate, times);
        }
    };
    const uint32_t first_looks = 4 * looks;
    std::vector<Candidate> some;
    double sum = 0;
    systematic(all, most, first_looks, [&](Candidate& candidate, uint32_t times) {
        const double lux = unshadowed(*candidate.lamp, candidate.way) * times * most / (first_looks * candidate.weight);
        if (lux > 0) some.push_back({candidate.lamp, candidate.way, lux}), sum += lux;
    });
    systematic(some, sum, looks, [&](const Candidate& candidate, uint32_t times) {
        if (blocked(*candidate.lamp, candidate.way, point, normal)) return;
        shares.push_back({candidate.lamp->node, times * sum / looks * glm::dvec3(candidate.lamp->lamp->colour)});
    });
}

}  // namespace vesper::transport
