#include "transport/light_tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/luminance.h"
#include "transport/reach.h"

namespace vesper::transport {
namespace {

constexpr double kPi = std::numbers::pi;

// SplitMix64 (Steele, Lea and Flood 2014).
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    // From 0 to 1, without 1.
    double next() {
        uint64_t z = state_ += 0x9e3779b97f4a7c15;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }

private:
    uint64_t state_;
};

double fraction(double value) { return value - std::floor(value); }

// Distributed as cosines about a unit normal; u and v from 0 to 1.
glm::dvec3 cosine_direction(glm::dvec3 normal, double u, double v) {
    const glm::dvec3 other = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(normal, other)), b = glm::cross(normal, a);
    const double sine = std::sqrt(u), turn = 2 * kPi * v;
    return sine * std::cos(turn) * a + sine * std::sin(turn) * b + std::sqrt(1 - u) * normal;
}

// Sums over paths of what each origin gives, and of its square.
struct Sums {
    std::array<glm::dvec3, kOrigins> rgb{};
    std::array<double, kOrigins> squares{};

    void add(const std::array<glm::dvec3, kOrigins>& path) {
        for (size_t i = 0; i < kOrigins; ++i) {
            rgb[i] += path[i];
            squares[i] += luminance(path[i]) * luminance(path[i]);
        }
    }
};

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
      lamps_(scene, world, rays_) {}

// A point that looks for emitters, and how often at which.
struct LightTracer::Way {
    glm::dvec3 point, normal;
    const EmitterChoice& choice;
};

// By the emitter and a place on it: luminance over the density of the direction, divided by pi, RGB cd/m^2. The density
// is that of both kinds of paths together (the balance heuristic).
glm::dvec3 LightTracer::look_at_emitter(const Way& way, double u, double v) const {
    const size_t number = way.choice.choose(u);
    const Emitters::Emitter& e = emitters_.list()[number];
    const double root = std::sqrt(u);  // even over the triangle (Turk 1990)
    const glm::dvec3 weights(1 - root, root * (1 - v), root * v);
    const glm::dvec3 place = weights.x * e.corners[0] + weights.y * e.corners[1] + weights.z * e.corners[2];
    const glm::dvec3 start = way.point + kSkin * way.normal, to = place - start;
    const double distance2 = glm::dot(to, to), distance = std::sqrt(distance2);
    const double cosine = glm::dot(way.normal, to) / distance, leaving = std::abs(glm::dot(e.outwards, to)) / distance;
    if (!(cosine > 0) || !(leaving > 1e-9)) return glm::dvec3(0);
    const SurfacePoint surface = surfaces_.at(
        {.share = 1, .node = e.node, .primitive = e.primitive, .triangle = e.triangle, .weights = weights}, start);
    if (surface.emission == glm::dvec3(0) || rays_.blocked(start, start + (1 - kSkin / std::max(distance, kSkin)) * to))
        return glm::dvec3(0);
    const double density = way.choice.probability(number) / e.area * distance2 / leaving;  // 1/sr
    return surface.emission * (cosine / kPi / (density + cosine / kPi));
}

// The share of a cosine-distributed path that meets an emitter.
double LightTracer::weight_of_hit(const Way& way, const rays::Hit& hit, const SurfacePoint& surface) const {
    const std::optional<size_t> number = emitters_.find(hit);
    if (!number || !way.choice.any()) return 1;
    const Emitters::Emitter& e = emitters_.list()[*number];
    const glm::dvec3 to = surface.position - way.point - kSkin * way.normal;
    const double distance2 = glm::dot(to, to), distance = std::sqrt(distance2);
    const double leaving = std::max(std::abs(glm::dot(e.outwards, to)) / distance, 1e-9);
    const double density = way.choice.probability(*number) / e.area * distance2 / leaving;
    const double cosine = glm::dot(way.normal, to) / distance;
    return cosine / kPi / (density + cosine / kPi);
}

glm::dvec3 LightTracer::sky(glm::dvec3 direction) const {
    if (scene_.environment) return photometry::luminance_of(*scene_.environment, direction);
    return double(scene_.sky_luminance) * glm::dvec3(scene_.sky_colour);
}

Illuminance LightTracer::at(glm::dvec3 point, glm::dvec3 normal, const TraceSettings& settings) const {
    // First directions follow the lattice of the generalized golden ratio (Roberts 2018), turned by the seed.
    constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
    Random random(settings.seed);
    const double turn_u = random.next(), turn_v = random.next();
    const EmitterChoice choice(emitters_.list(), point, normal);
    const Way first{point, normal, choice};
    Sums sums;
    for (uint32_t path = 0; path < settings.paths; ++path) {
        std::array<glm::dvec3, kOrigins> got{};
        glm::dvec3 from = point, facing = normal, kept(1);
        double u = fraction(turn_u + path * kFirst), v = fraction(turn_v + path * kSecond);
        if (choice.any()) got[size_t(Origin::Emitters)] += look_at_emitter(first, u, v);
        for (uint32_t reflections = 0; reflections <= settings.most_reflections; ++reflections) {
            const glm::dvec3 way = cosine_direction(facing, u, v), start = from + kSkin * facing;
            const std::optional<rays::Hit> hit = rays_.nearest(start, start + kReach * way);
            const auto direct = [&](Origin origin) -> glm::dvec3& {
                return got[size_t(reflections == 0 ? origin : reflected(reflections))];
            };
            if (!hit) {
                direct(Origin::Sky) += kept * sky(way);
                break;
            }
            const SurfacePoint surface = surfaces_.at(*hit, start);
            if (surface.emission != glm::dvec3(0))
                direct(Origin::Emitters) +=
                    kept * surface.emission * (reflections == 0 ? weight_of_hit(first, *hit, surface) : 1);
            kept *= surface.reflectance;
            const double most = std::max({kept.x, kept.y, kept.z});
            if (most <= 0 || reflections == settings.most_reflections) break;
            const glm::dvec3 lit = lamps_.illuminance(surface.position, surface.normal, settings.threshold);
            got[size_t(reflected(reflections + 1))] += kept * lit / kPi;
            if (reflections >= 2) {  // few paths go on, for more (Arvo and Kirk 1990)
                if (random.next() >= std::min(most, 0.95)) break;
                kept /= std::min(most, 0.95);
            }
            from = surface.position, facing = surface.normal;
            u = random.next(), v = random.next();
        }
        sums.add(got);
    }
    Illuminance result;
    const double paths = std::max(settings.paths, 1u);
    for (size_t i = 0; i < kOrigins; ++i) {
        result.rgb[i] = kPi / paths * sums.rgb[i];
        const double mean = luminance(sums.rgb[i]) / paths;
        result.standard_error[i] = kPi * std::sqrt(std::max(sums.squares[i] / paths - mean * mean, 0.0) / paths);
    }
    result.rgb[size_t(Origin::Lamps)] = lamps_.illuminance(point, normal, settings.threshold);
    result.standard_error[size_t(Origin::Lamps)] = 0;
    return result;
}

}  // namespace vesper::transport
