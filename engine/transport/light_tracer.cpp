#include "transport/light_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/budget.h"
#include "base/luminance.h"
#include "scene/scene.h"
#include "transport/reach.h"
#include "transport/sampling.h"

namespace vesper::transport {
namespace {

constexpr double kPi = std::numbers::pi;

// Sums over paths of what each origin gives, and of its square.
struct Sums {
    std::array<glm::dvec3, kOrigins> rgb{};
    std::array<double, kOrigins> squares{};
    double sum = 0, square = 0;  // of all origins

    void add(const std::array<glm::dvec3, kOrigins>& path) {
        double all = 0;
        for (size_t i = 0; i < kOrigins; ++i) {
            const double here = luminance(path[i]);
            rgb[i] += path[i], squares[i] += here * here, all += here;
        }
        sum += all, square += all * all;
    }
};

// Of a mean over paths.
double error_of(double sum, double squares, double paths) {
    const double mean = sum / paths;
    return std::sqrt(std::max(squares / paths - mean * mean, 0.0) / paths);
}

Origin reflected(uint32_t times) { return times == 1 ? Origin::Once : Origin::More; }

}  // namespace

glm::dvec3 Illuminance::sum() const {
    glm::dvec3 all(0);
    for (const glm::dvec3 part : rgb) all += part;
    return all;
}

LightTracer::LightTracer(const scene::Scene& scene, std::span<const glm::dmat4> world)
    : scene_(scene),
      rays_(scene, world),
      surfaces_(scene, world),
      emitters_(scene, world, surfaces_),
      by_power_(emitters_),
      lamps_(scene, world, rays_) {}

// A point that looks for emitters, and how often at which.
struct LightTracer::Way {
    glm::dvec3 point, normal;
    const EmitterChoice* choice;
};

// Of the density of paths to a place on an emitter, the share of those that go by chance, distributed as cosines (the
// balance heuristic).
double LightTracer::cosine_share(const Way& way, size_t number, glm::dvec3 to) const {
    const double cosine = glm::dot(way.normal, to) / glm::length(to);
    return cosine / kPi / (way.choice->density(number, to) + cosine / kPi);
}

// By the emitter and a place on it: luminance over the density of the direction, divided by pi, RGB cd/m^2. The density
// is that of both kinds of paths together.
glm::dvec3 LightTracer::look_at_emitter(const Way& way, glm::dvec2 chance) const {
    const size_t number = way.choice->choose(chance.x);
    const Emitters::Emitter& e = emitters_.list()[number];
    const auto [place, wanted] = emitters_.place_on(number, chance);
    const glm::dvec3 start = way.point + skin_at(rays_, way.point) * way.normal, to = place - start;
    const double distance = glm::length(to), leaving = std::abs(glm::dot(e.outwards, to)) / distance;
    if (!(glm::dot(way.normal, to) > 0) || !(leaving > kLeastLeaving) || !(distance < kReach)) return glm::dvec3(0);
    const glm::dvec3 emission = surfaces_.emission(wanted, start);
    if (emission == glm::dvec3(0)) return glm::dvec3(0);
    // It is seen if a path that way would meet it: not where it has a hole, nor where another surface lies on it.
    const std::optional<rays::Hit> hit = rays_.nearest(start, start + kReach / distance * to);
    if (!hit || hit->node != e.node || hit->primitive != e.primitive || hit->triangle != e.triangle)
        return glm::dvec3(0);
    return emission * cosine_share(way, number, to);
}

// The share of a cosine-distributed path that meets an emitter.
double LightTracer::weight_of_hit(const Way& way, const rays::Hit& hit, const SurfacePoint& surface) const {
    const std::optional<size_t> number = emitters_.find(hit);
    if (!number || !way.choice->any()) return 1;
    return cosine_share(way, *number, surface.position - way.point - skin_at(rays_, way.point) * way.normal);
}

glm::dvec3 LightTracer::sky(glm::dvec3 direction) const {
    if (scene_.environment) return photometry::luminance_of(*scene_.environment, direction);
    return double(scene_.sky_luminance) * glm::dvec3(scene_.sky_colour);
}

// lx, on a place that reflects it.
glm::dvec3 LightTracer::light_of_lamps(const SurfacePoint& surface, uint32_t node, const TraceSettings& settings,
                                       Random& random) const {
    if (settings.lamp_rays == 0) return lamps_.illuminance(surface.position, surface.normal, settings.threshold, node);
    std::vector<LampLight::Share> shares;
    const SurfacePlace place{surface.position, surface.normal, node};
    lamps_.sample({&place, 1}, settings.lamp_rays, random, shares);
    glm::dvec3 sum(0);
    for (const LampLight::Share& share : shares) sum += share.lux;
    return sum;
}

Illuminance LightTracer::at(glm::dvec3 point, glm::dvec3 normal, const TraceSettings& settings) const {
    Random random(settings.seed);
    const Lattice first_directions(random);
    const EmitterChoice choice(emitters_, {.middle = point, .normal = normal});
    Sums sums;
    for (uint32_t path = 0; path < settings.paths; ++path) {
        check_time();
        std::array<glm::dvec3, kOrigins> got{};
        Way way{point, normal, &choice};
        glm::dvec3 kept(1);
        glm::dvec2 chance = first_directions.at(path);
        if (choice.any()) got[size_t(Origin::Emitters)] += look_at_emitter(way, chance);
        for (uint32_t reflections = 0;; ++reflections) {
            const glm::dvec3 direction = cosine_direction(way.normal, chance);
            const glm::dvec3 start = way.point + skin_at(rays_, way.point) * way.normal;
            const std::optional<rays::Hit> hit = rays_.nearest(start, start + kReach * direction);
            const auto direct = [&](Origin origin) -> glm::dvec3& {
                return got[size_t(reflections == 0 ? origin : reflected(reflections))];
            };
            if (!hit) {
                direct(Origin::Sky) += kept * sky(direction);
                break;
            }
            const SurfacePoint surface = surfaces_.at(*hit, start);
            if (surface.emission != glm::dvec3(0))
                direct(Origin::Emitters) += kept * surface.emission * weight_of_hit(way, *hit, surface);
            kept *= surface.reflectance;
            const double most = std::max({kept.x, kept.y, kept.z});
            if (most <= 0 || reflections == settings.most_reflections) break;
            way = {surface.position, surface.normal, &by_power_};
            glm::dvec3 sent = light_of_lamps(surface, hit->node, settings, random) / kPi;
            if (by_power_.any()) {
                const double first = random.next();
                sent += look_at_emitter(way, {first, random.next()});
            }
            got[size_t(reflected(reflections + 1))] += kept * sent;
            if (reflections >= 2) {  // few paths go on, for more (Arvo and Kirk 1990)
                if (random.next() >= std::min(most, 0.95)) break;
                kept /= std::min(most, 0.95);
            }
            chance.x = random.next(), chance.y = random.next();
        }
        sums.add(got);
    }
    Illuminance result;
    const double paths = std::max(settings.paths, 1u);
    for (size_t i = 0; i < kOrigins; ++i) {
        result.rgb[i] = kPi / paths * sums.rgb[i];
        result.standard_error[i] = kPi * error_of(luminance(sums.rgb[i]), sums.squares[i], paths);
    }
    result.rgb[size_t(Origin::Lamps)] = lamps_.illuminance(point, normal, settings.threshold);
    result.standard_error_of_sum = kPi * error_of(sums.sum, sums.square, paths);
    return result;
}

}  // namespace vesper::transport
