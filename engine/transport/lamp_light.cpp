#include "transport/lamp_light.h"

#include <algorithm>
#include <cmath>

#include "photometry/distribution.h"
#include "scene/fixtures.h"
#include "scene/lamp.h"
#include "transport/reach.h"

namespace vesper::transport {
namespace {

constexpr double kDark = 1e-200;  // lx: less is rounding

}  // namespace

LampLight::LampLight(const scene::Scene& scene, std::span<const glm::dmat4> world, const rays::RayCaster& rays)
    : scene_(scene), rays_(rays), in_fixture_(scene.nodes.size()) {
    const std::vector<uint32_t> nodes = scene::nodes_with_lamps(scene);
    std::vector<std::vector<uint32_t>> fixtures = scene::fixture_nodes(scene, nodes, world);
    for (size_t i = 0; i < nodes.size(); ++i) {
        const scene::Lamp& lamp = scene.lamps[scene.nodes[nodes[i]].lamp];
        const glm::dmat4& at = world[nodes[i]];
        double largest = double(lamp.intensity);
        if (lamp.kind == scene::Lamp::Kind::Measured)
            largest *= photometry::largest_intensity(scene.distributions[lamp.distribution]);
        const glm::dmat3 frame = scene::lamp_frame(at);
        const bool directional = lamp.kind == scene::Lamp::Kind::Directional;
        bounds_.push_back({directional ? kReach * frame[2] : glm::dvec3(at[3]), largest, directional});
        for (const uint32_t node : fixtures[i]) in_fixture_[node] = true;
        lamps_.push_back({nodes[i], &lamp, glm::transpose(frame), std::move(fixtures[i]),
                          scene::housing_reach(scene.nodes[nodes[i]])});
    }
}

// From a point of a surface.
struct LampLight::Way {
    glm::dvec3 to;     // m; of directional lamps kReach
    double cosine;     // with the normal
    double distance2;  // that it takes light, m^2; directional: 1
    double bound() const { return cosine > 0 ? cosine / distance2 : 0; }
};

inline LampLight::Way LampLight::way_to(const Bound& lamp, glm::dvec3 point, glm::dvec3 normal) {
    const glm::dvec3 to = lamp.directional ? lamp.place : lamp.place - point;
    const double distance2 = glm::dot(to, to);
    return {to, glm::dot(normal, to) / std::max(std::sqrt(distance2), 1e-300), lamp.directional ? 1 : distance2};
}

// lx, if nothing stands between.
double LampLight::unshadowed(size_t lamp, const Way& way) const {
    const Placed& placed = lamps_[lamp];
    const double intensity = bounds_[lamp].directional ? bounds_[lamp].largest
                                                       : scene::luminous_intensity(*placed.lamp, scene_.distributions,
                                                                                   placed.to_lamp * -way.to);
    return intensity * way.bound();
}

bool LampLight::blocked(size_t lamp, const Way& way, glm::dvec3 point, glm::dvec3 normal) const {
    const glm::dvec3 start = point + skin_at(rays_, point) * normal;
    const Bound& bound = bounds_[lamp];
    return rays_.blocked(start, bound.directional ? start + way.to : bound.place, lamps_[lamp].fixture);
}

bool LampLight::lights(size_t lamp, uint32_t node, const Way& way) const {
    if (node == scene::kNone || !in_fixture_[node]) return true;
    const Placed& placed = lamps_[lamp];
    return !(glm::length(way.to) <= placed.housing) || !std::ranges::binary_search(placed.fixture, node);
}

glm::dvec3 LampLight::illuminance(glm::dvec3 point, glm::dvec3 normal, double threshold, uint32_t node) const {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < lamps_.size(); ++i) {
        const Way way = way_to(bounds_[i], point, normal);
        if (!(way.cosine > 0) || !(bounds_[i].largest * way.cosine >= threshold * way.distance2)) continue;
        if (!lights(i, node, way)) continue;
        const double lux = unshadowed(i, way);
        if (lux < threshold || lux == 0 || blocked(i, way, point, normal)) continue;
        sum += lux * glm::dvec3(lamps_[i].lamp->colour);
    }
    return sum;
}

void LampLight::sample(glm::dvec3 point, glm::dvec3 normal, uint32_t node, uint32_t rays, Random& random,
                       std::vector<Share>& shares) const {
    // The numbers of even steps through the sum of all weights that fall into each.
    const auto systematic = [&random](std::span<const double> weights, double sum, uint32_t steps, auto take) {
        if (!(sum > kDark)) return;
        const double start = random.next();
        double at = 0;
        uint32_t step = 0;
        for (size_t i = 0; i < weights.size(); ++i) {
            at += weights[i];
            uint32_t times = 0;
            for (; step < steps && (start + step) * sum / steps < at; ++step) ++times;
            if (times > 0) take(i, times);
        }
    };
    // First by what a lamp may give at most, then, of some, by what they give.
    std::vector<double> most(lamps_.size());
    double all = 0;
    for (size_t i = 0; i < lamps_.size(); ++i) {
        const Way way = way_to(bounds_[i], point, normal);
        const double bound = bounds_[i].largest * way.bound();
        if (bound > 0 && lights(i, node, way)) all += most[i] = bound;
    }
    const uint32_t candidates = 4 * rays;
    std::vector<size_t> some;
    std::vector<double> lux;
    double sum = 0;
    systematic(most, all, candidates, [&](size_t i, uint32_t times) {
        const double given = unshadowed(i, way_to(bounds_[i], point, normal)) * times * all / (candidates * most[i]);
        if (given > 0) some.push_back(i), lux.push_back(given), sum += given;
    });
    systematic(lux, sum, rays, [&](size_t chosen, uint32_t times) {
        const size_t i = some[chosen];
        if (blocked(i, way_to(bounds_[i], point, normal), point, normal)) return;
        shares.push_back({lamps_[i].node, times * sum / rays * glm::dvec3(lamps_[i].lamp->colour)});
    });
}

}  // namespace vesper::transport
